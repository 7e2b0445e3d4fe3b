#include "bench/structures/summaries.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "bench/bar.hpp"
#include "bench/statistics.hpp"
#include "bench/structures/plans.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

struct Known {
    const char *structure, *text;
};
constexpr std::array known = {
    Known{"brute_force", "Every triangle is asked: for a handful, and as a reference."},
    Known{"grid",
          "For triangles of one size, evenly spread (Fujimoto, Tanaka, Iwata 1986); a teapot in a stadium falls into few cells."},
    Known{"octree", "For scenes that are empty here and crowded there (Glassner 1984)."},
    Known{"kd_tree",
          "Planes across the axes by the surface area heuristic, which cuts off empty space; a triangle counts in each leaf that "
          "it reaches into (Wald and Havran 2006)."},
    Known{"bsp_tree",
          "Planes along slanted triangles, which boxes enclose badly; slow to build (Kammaje and Mora 2007; Ize, Wald, "
          "Parker 2008)."},
    Known{"bvh", "Each triangle once, so memory is known beforehand; boxes may overlap (Wald 2007)."},
    Known{"wide_bvh", "The same with 8 boxes tested at once (Wald, Benthin, Boulos 2008)."},
};

/// The median ratio of a contender over the rays of a scene; NaN where it was not traced.
double scene_ratio(const SceneBench& scene, const std::string& contender) {
    std::vector<double> ratios;
    for (const Timing& timing : scene.timings) {
        const bool counts = scene.builds[timing.build].contender == contender && !is_blind(scene.ray_sets[timing.ray_set]);
        if (counts && timing.ratio) ratios.push_back(*timing.ratio);
    }
    return median(ratios);
}

Samples scene_ratios(const StructureBench& structures, const std::string& contender) {
    Samples samples;
    for (const StructureScene& scene : structures.scenes) {
        const double ratio = scene_ratio(scene.bench, contender);
        if (ratio > 0) samples.push_back({ratio, scene.bench.name});
    }
    return samples;
}

bool by_value(const Sample& a, const Sample& b) { return a.value < b.value; }

std::string times(const Sample& sample) { return figure(sample.value, "%.3g") + " times the BVH's speed on " + sample.where; }

/// " Here ..." where there are figures.
std::string measured(const Samples& samples) {
    if (samples.empty()) return "";
    const auto [worst, best] = std::minmax_element(samples.begin(), samples.end(), by_value);
    if (samples.size() == 1) return " Here " + times(*best) + ".";
    return " Here at best " + times(*best) + ", at worst " + times(*worst) + ".";
}

/// "grid on soup; kd_tree on hair, bunny": the scenes by the structure that was the fastest.
std::string fastest(const StructureBench& structures, const std::vector<std::string>& contenders) {
    std::map<std::string, std::string> scenes_by_structure;
    for (const StructureScene& scene : structures.scenes) {
        Sample best{0, ""};
        for (const std::string& contender : contenders) {
            const double ratio = scene_ratio(scene.bench, contender);
            if (ratio > best.value) best = {ratio, contender};
        }
        if (best.where.empty()) continue;
        std::string& names = scenes_by_structure[best.where];
        names += (names.empty() ? "" : ", ") + scene.bench.name;
    }
    std::string text;
    for (const auto& [structure, names] : scenes_by_structure) text += (text.empty() ? "" : "; ") + structure + " on " + names;
    return text;
}

}  // namespace

std::vector<StructureSummary> summarize_structures(const StructureBench& structures) {
    std::vector<StructureSummary> summaries;
    std::vector<std::string> all, scalar;
    for (const auto& [structure, text] : known) {
        const bool is_reference = structure == std::string(reference_structure);
        summaries.push_back({structure, text + (is_reference ? "" : measured(scene_ratios(structures, structure)))});
        all.push_back(structure);
        if (structure != std::string("wide_bvh")) scalar.push_back(structure);
    }
    if (structures.scenes.empty()) return summaries;
    summaries.push_back({"fastest", "By the median over a scene's rays: " + fastest(structures, all) +
                                        ". Of those that test one box, cell or plane at a time: " + fastest(structures, scalar) +
                                        "."});
    return summaries;
}

}  // namespace harness
