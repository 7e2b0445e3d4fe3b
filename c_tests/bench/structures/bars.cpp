#include "bench/structures/bars.hpp"

#include "bench/bar.hpp"
#include "bench/structures/plans.hpp"
#include "bench/structures/summaries.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

constexpr std::size_t least_triangles = 50'000, most_triangles = 1'000'000;

struct Wanted {
    std::string contender, scene, kind;  // "": any scene, any kind of rays
};

Samples ratios(const StructureBench& structures, const Wanted& wanted) {
    Samples samples;
    for (const auto& [scene, work] : structures.scenes) {
        const bool fits = scene.triangle_count >= least_triangles && scene.triangle_count <= most_triangles &&
                          (wanted.scene.empty() || scene.name == wanted.scene);
        if (!fits) continue;
        for (const Timing& timing : scene.timings) {
            const RaySetInfo& set = scene.ray_sets[timing.ray_set];
            const bool counts = scene.builds[timing.build].contender == wanted.contender && timing.ratio && !is_blind(set) &&
                                (wanted.kind.empty() || set.kind == wanted.kind);
            if (counts)
                samples.push_back({*timing.ratio, scene.name + (set.view.empty() ? " " : " " + set.view + " ") + set.kind});
        }
    }
    return samples;
}

Samples build_seconds(const StructureBench& structures, const std::string& contender, bool (*counts)(std::size_t)) {
    Samples samples;
    for (const Growth& growth : structures.growth) {
        if (growth.engine == contender && counts(growth.triangle_count))
            samples.push_back({growth.build_seconds, grouped(growth.triangle_count) + " triangles"});
    }
    return samples;
}

Bar build_bar(const StructureBench& structures, const std::string& contender, double most_seconds) {
    return cost_bar(contender + ": build of 10^6 triangles", build_seconds(structures, contender, is_about_a_million),
                    Counts::median, most_seconds, " s", "");
}

}  // namespace

std::vector<Bar> judge_structure_bars(const StructureBench& structures) {
    const auto ratio_bar = [&](const std::string& what, const Wanted& wanted, double least) {
        return speed_bar(what, ratios(structures, wanted), least, "");
    };
    std::vector<Bar> bars = {
        ratio_bar("kd_tree", {"kd_tree", "", ""}, 0.8),
        ratio_bar("grid, evenly spread soup", {"grid", evenly_spread_scene, ""}, 1.0),
        shown_bar("grid, teapot in a stadium", ratios(structures, {"grid", unevenly_spread_scene, ""})),
        ratio_bar("octree", {"octree", "", ""}, 0.4),
        ratio_bar("bsp_tree", {"bsp_tree", "", ""}, 0.3),
        ratio_bar("bvh high, bounce", {"bvh high", "", "bounce"}, 1.1),
    };
    bars.push_back(build_bar(structures, "grid", 0.5));
    bars.push_back(build_bar(structures, "octree", 2));
    bars.push_back(build_bar(structures, "kd_tree", 4));
    bars.push_back(build_bar(structures, "bvh high", 3));
    const auto is_most_of_bsp = [](std::size_t count) { return count >= most_bsp_triangles * 9 / 10; };
    bars.push_back(cost_bar("bsp_tree: build of 10^5 triangles", build_seconds(structures, "bsp_tree", is_most_of_bsp),
                            Counts::median, 30, " s", ""));
    return bars;
}

}  // namespace harness
