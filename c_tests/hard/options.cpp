#include "hard/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <set>

#include "hard/cases.hpp"
#include "hard/engines.hpp"
#include "hard/populations.hpp"

namespace harness {
namespace {

std::vector<std::string> population_names() {
    std::vector<std::string> names;
    for (const Population& population : populations()) names.push_back(population.name);
    return names;
}

std::vector<std::string> case_numbers() {
    std::set<int> numbers;
    for (const HardCase& hard_case : hard_cases()) numbers.insert(hard_case.number);
    std::vector<std::string> names;
    for (const int number : numbers) names.push_back(std::to_string(number));
    return names;
}

/// A list that is "all" of the names by default; "none" is a name of its own where `may_be_none`.
void declare_list(CLI::App& app, const std::string& option, std::vector<std::string>& words, std::vector<std::string> names,
                  const std::string& what, bool may_be_none = false) {
    std::vector<std::string> known = names;
    known.push_back("all");
    if (may_be_none) known.push_back("none");
    app.add_option(option, words, what)
        ->delimiter(',')
        ->check(CLI::IsMember(known))
        ->default_val(std::vector<std::string>{"all"});
}

void resolve(std::vector<std::string>& words, const std::vector<std::string>& names) {
    if (std::ranges::count(words, "all") != 0) words = names;
    std::erase(words, "none");
}

}  // namespace

std::optional<HardOptions> parse_hard_options(int argc, char** argv, int& status) {
    HardOptions options;
    CLI::App app{
        "Runs the populations and hard cases that rays and triangles are known to go wrong at, through every structure,\n"
        "precision and instruction set of gnomon and through Embree, each answer judged by an exact oracle.\n"
        "Exit status: 0; 1 when gnomon breaks a bar of correctness; 2 for unusable input.",
        "gnomon-hard"};
    app.add_option("--rays", options.ray_count, "rays of each population and case; from 20,000 on, cases of 10^6 triangles too")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000'000}))
        ->capture_default_str();
    app.add_option("--seed", options.seed, "of all rays and scenes")->capture_default_str();
    declare_list(app, "--populations", options.populations, population_names(), "populations, by name, or all or none", true);
    declare_list(app, "--cases", options.cases, case_numbers(), "hard cases, by number, or all or none", true);
    declare_list(app, "--structures", options.structures, structure_words(), "gnomon's structures");
    declare_list(app, "--precisions", options.precisions, precision_words(), "gnomon's precisions");
    declare_list(app, "--isas", options.isas, isa_words(), "instruction sets, of structures that have kernels for them");
    app.add_flag("!--skip-timing", options.timing, "does not measure what precision costs");
    app.add_option("--json", options.json_path, "writes everything, machine-readable");
    app.add_option("--dump-failures", options.failures_path,
                   "writes each of gnomon's faults, with the command that replays it, and beside them their scenes");
    try {
        app.parse(argc, argv);
        resolve(options.populations, population_names());
        resolve(options.cases, case_numbers());
        resolve(options.structures, structure_words());
        resolve(options.precisions, precision_words());
        resolve(options.isas, isa_words());
        return options;
    } catch (const CLI::Success& success) {
        status = app.exit(success);
    } catch (const CLI::Error& error) {
        std::fprintf(stderr, "gnomon-hard: %s\n", error.what());
        status = 2;
    }
    return {};
}

}  // namespace harness
