// gnomon-bench: gnomon against Embree and against the project's bars.
#include <cstdio>
#include <exception>

#include "backend/trace_loop.hpp"
#include "bench/bars.hpp"
#include "bench/call_cost.hpp"
#include "bench/degenerate.hpp"
#include "bench/growth.hpp"
#include "bench/html.hpp"
#include "bench/json.hpp"
#include "bench/options.hpp"
#include "bench/scene_bench.hpp"
#include "bench/scenes.hpp"
#include "bench/structures/run.hpp"
#include "bench/table.hpp"
#include "harness/write_file.hpp"
#include "scene/load.hpp"

namespace {

using namespace harness;

constexpr int unusable_input = 2;

void print(const std::string& text) {
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
}

/// Prints the notes that came in since the last call.
void print_notes(const BenchResults& results, std::size_t& printed) {
    for (; printed < results.notes.size(); ++printed) std::fprintf(stderr, "gnomon-bench: %s\n", results.notes[printed].c_str());
}

void run_scenes(const BenchOptions& options, BenchResults& results, std::size_t& printed) {
    for (const SceneChoice& choice : choose_scenes(options, results.notes)) {
        const Scene scene = load_scene(choice.spec);
        if (scene.triangle_count() < choice.least_triangles) continue;
        SceneBench bench = bench_scene(scene, options, results.notes);
        bench.generated = choice.spec.starts_with("gen:");
        print_notes(results, printed);
        print(scene_text(bench));
        results.scenes.push_back(std::move(bench));
    }
}

BenchResults run(const BenchOptions& options) {
    BenchResults results;
    std::size_t printed = 0;
    const Clock::time_point start = Clock::now();
    const bool beside_embree = options.parts != std::vector<std::string>{"structures"};
    if (beside_embree && embree_version().empty())
        results.notes.push_back("built without Embree: gnomon is measured alone, and there are no ratios");
    print_notes(results, printed);
    if (options.has_part("scenes")) run_scenes(options, results, printed);
    if (options.has_part("calls")) print(call_cost_text(results.call_costs = measure_call_costs(options)));
    if (options.has_part("growth")) print(growth_text(results.growth = measure_growth(options, results.notes)));
    if (options.has_part("degenerate")) print(degenerate_text(results.degenerate = measure_degenerate(options)));
    if (options.has_part("structures")) results.structures = measure_structures(options, results.notes, print);
    print_notes(results, printed);
    results.seconds = seconds_since(start);
    if (!beside_embree) return results;
    results.bars = judge_bars(results);
    print(bars_text(results.bars, "median over scenes and views, one thread, ratio to Embree's default, ACCURATE unless said"));
    return results;
}

}  // namespace

int main(int argc, char** argv) {
    int status = 0;
    const std::optional<BenchOptions> options = parse_bench_options(argc, argv, status);
    if (!options) return status;
    try {
        const nlohmann::ordered_json json = bench_json(run(*options));
        if (!options->json_path.empty()) write_file(options->json_path, json.dump(2) + "\n");
        if (!options->html_path.empty()) write_file(options->html_path, bench_html(json));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gnomon-bench: %s\n", error.what());
        return unusable_input;
    }
}
