// gnomon-compare: gnomon beside Embree on the same scenes and rays.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "compare/html.hpp"
#include "compare/json.hpp"
#include "compare/options.hpp"
#include "compare/replay.hpp"
#include "compare/run.hpp"
#include "compare/table.hpp"
#include "harness/write_file.hpp"

namespace {

using namespace harness;

enum ExitStatus { kept_contract = 0, broke_contract = 1, unusable_input = 2 };

void print_warnings(Notes& notes) {
    for (const std::string& warning : notes.warnings) std::fprintf(stderr, "gnomon-compare: %s\n", warning.c_str());
    notes.warnings.clear();
}

std::vector<SceneResult> run_all(const Options& options, Notes& notes) {
    std::vector<SceneResult> results;
    for (const std::string& spec : options.scenes) {
        results.push_back(run_scene(spec, options, notes));
        print_warnings(notes);
        std::printf("%s\n", to_table(results.back()).c_str());
        std::fflush(stdout);
    }
    return results;
}

void write_reports(const Options& options, const std::vector<SceneResult>& results, const Notes& notes) {
    const nlohmann::ordered_json json = to_json(this_machine(), these_versions(), results);
    if (!options.json_path.empty()) write_file(options.json_path, json.dump(2) + "\n");
    if (!options.html_path.empty()) write_file(options.html_path, to_html(json, results));
    if (!options.failures_path.empty()) {
        std::string text;
        for (const std::string& fault : notes.faults) text += fault + "\n";
        write_file(options.failures_path, text);
    }
}

ExitStatus compare(const Options& options) {
    Notes notes;
    if (embree_version().empty()) {
        notes.warnings.push_back("built without Embree: gnomon is measured alone, and there are no ratios");
        print_warnings(notes);
    }
    if (options.replay) {
        bool kept = true;
        for (const std::string& spec : options.scenes) kept &= replay_ray(spec, options, notes);
        print_warnings(notes);
        return kept ? kept_contract : broke_contract;
    }
    const std::vector<SceneResult> results = run_all(options, notes);
    write_reports(options, results, notes);
    if (notes.faults.empty()) return kept_contract;
    std::fprintf(stderr, "gnomon-compare: %zu answers outside gnomon's contract, the first:\n%s", notes.faults.size(),
                 notes.faults.front().c_str());
    return broke_contract;
}

}  // namespace

int main(int argc, char** argv) {
    int status = kept_contract;
    const std::optional<Options> options = parse_options(argc, argv, status);
    if (!options) return status;
    try {
        return compare(*options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gnomon-compare: %s\n", error.what());
        return unusable_input;
    }
}
