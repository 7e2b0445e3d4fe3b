// gnomon-hard: everything that rays and triangles are known to go wrong at.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "backend/trace_loop.hpp"
#include "hard/bars.hpp"
#include "hard/cases.hpp"
#include "hard/costs.hpp"
#include "hard/json.hpp"
#include "hard/judge_population.hpp"
#include "hard/table.hpp"
#include "harness/progress.hpp"
#include "harness/write_file.hpp"

namespace {

using namespace harness;

enum ExitStatus { kept_bars = 0, broke_bar = 1, unusable_input = 2 };

void print(const std::string& text) {
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
}

bool is_listed(const std::vector<std::string>& words, const std::string& word) { return std::ranges::count(words, word) != 0; }

template <class T>
void append(std::vector<T>& to, std::vector<T> from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

HardResults run(const HardOptions& options, Failures& failures) {
    const Clock::time_point start = Clock::now();
    HardResults results;
    const std::vector<HardEngine> engines = hard_engines(options, results.notes);
    {
        Progress progress(options.populations.size() + options.cases.size(), "populations");
        for (const Population& population : populations()) {
            if (!is_listed(options.populations, population.name)) continue;
            progress.set_label(population.name + ": " + population.what);
            append(results.populations, judge_population(population, options, engines, failures));
            progress.advance();
        }
        int last_number = 0;
        for (const HardCase& hard_case : hard_cases()) {
            if (!is_listed(options.cases, std::to_string(hard_case.number))) continue;
            progress.set_label("case " + std::to_string(hard_case.number) + ": " + hard_case.name);
            CaseRun case_run(hard_case, options, engines, failures);
            hard_case.run(case_run);
            append(results.cases, case_run.take_rows());
            progress.advance(hard_case.number != last_number ? 1 : 0);
            last_number = hard_case.number;
        }
    }
    if (options.timing) {
        results.invalid = measure_invalid_cost(options);
        results.costs = measure_precision_costs(options, results.notes);
    }
    results.bars = judge_hard_bars(results);
    results.seconds = seconds_since(start);
    return results;
}

ExitStatus run_and_report(const HardOptions& options) {
    Failures failures(options.failures_path);
    const HardResults results = run(options, failures);
    for (const std::string& note : results.notes) std::fprintf(stderr, "gnomon-hard: %s\n", note.c_str());
    if (!results.populations.empty()) print(population_text(results.populations));
    if (!results.cases.empty()) print(case_text(results.cases));
    print(bars_text(results.bars));
    if (!options.json_path.empty()) write_file(options.json_path, hard_json(options, results).dump(2) + "\n");
    failures.write();
    if (!failures.texts().empty())
        std::fprintf(stderr, "gnomon-hard: answers outside gnomon's contract, the first:\n%s", failures.texts().front().c_str());
    return failures.texts().empty() && is_correct(results.bars) ? kept_bars : broke_bar;
}

}  // namespace

int main(int argc, char** argv) {
    int status = kept_bars;
    const std::optional<HardOptions> options = parse_hard_options(argc, argv, status);
    if (!options) return status;
    try {
        return run_and_report(*options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gnomon-hard: %s\n", error.what());
        return unusable_input;
    }
}
