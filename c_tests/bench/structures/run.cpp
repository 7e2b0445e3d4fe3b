#include "bench/structures/run.hpp"

#include <algorithm>

#include "bench/scenes.hpp"
#include "bench/structures/bars.hpp"
#include "bench/structures/grid_sweep.hpp"
#include "bench/structures/growth.hpp"
#include "bench/structures/structure_scene.hpp"
#include "bench/structures/summaries.hpp"
#include "bench/structures/table.hpp"
#include "bench/table.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

/// A scene of the command line is swept whatever it is.
bool is_swept(const Scene& scene, const BenchOptions& options) {
    return !options.scenes.empty() || scene.name == evenly_spread_scene || scene.name == unevenly_spread_scene;
}

/// There are many of them, and some are slow: fewer rays, and builds where asked to be quick.
BenchOptions shortened(BenchOptions options) {
    options.ray_count = (options.ray_count + 1) / 2;
    if (options.quick) options.build_repeats = std::min(options.build_repeats, 1u);
    return options;
}

}  // namespace

StructureBench measure_structures(const BenchOptions& all_options, std::vector<std::string>& notes,
                                  const std::function<void(const std::string&)>& print) {
    const BenchOptions options = shortened(all_options);
    StructureBench structures;
    for (const SceneChoice& choice : choose_structure_scenes(options)) {
        const Scene scene = load_scene(choice.spec);
        structures.scenes.push_back(bench_structures(scene, options, notes));
        structures.scenes.back().bench.generated = choice.spec.starts_with("gen:");
        print(structure_scene_text(structures.scenes.back()));
        if (!is_swept(scene, options)) continue;
        structures.grid_sweeps.push_back(sweep_grid(scene, options, notes));
        print(grid_sweep_text(structures.grid_sweeps.back()));
    }
    structures.growth = measure_structure_growth(options, notes);
    print(structure_growth_text(structures.growth));
    structures.bars = judge_structure_bars(structures);
    print(bars_text(structures.bars,
                    "structures: median over scenes and rays, fresh calls on one thread, ratio to the scalar BVH, MEDIUM"));
    structures.summaries = summarize_structures(structures);
    print(summaries_text(structures.summaries));
    return structures;
}

}  // namespace harness
