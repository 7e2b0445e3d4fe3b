#include "bench/structures/plans.hpp"

#include "backend/names.hpp"

namespace harness {
namespace {

/// Up to here a BSP tree is built as often as the others.
constexpr std::size_t few_triangles = 10'000;

std::uint32_t structure_of(const std::string& name) {
    for (const NamedValue& named : structure_names) {
        if (named.name == name) return named.value;
    }
    return GNOMON_STRUCTURE_AUTO;
}

}  // namespace

Plan structure_plan(const std::string& structure, std::uint32_t quality, const BenchOptions& options) {
    const std::string suffix = quality == GNOMON_QUALITY_MEDIUM ? "" : " " + name_of(quality_names, quality);
    Plan plan = gnomon_plan(structure + suffix, options);
    plan.build.structure = structure_of(structure);
    plan.build.quality = quality;
    plan.timed = true;
    return plan;
}

std::vector<Plan> structure_plans(const BenchOptions& options, std::size_t triangle_count, Qualities qualities) {
    std::vector<Plan> plans;
    for (const char* structure : {reference_structure, "brute_force", "grid", "octree", "kd_tree", "bsp_tree", "wide_bvh"}) {
        plans.push_back(structure_plan(structure, GNOMON_QUALITY_MEDIUM, options));
    }
    plans.push_back(structure_plan(reference_structure, GNOMON_QUALITY_HIGH, options));
    if (qualities == Qualities::all) {
        plans.push_back(structure_plan(reference_structure, GNOMON_QUALITY_LOW, options));
        for (const char* structure : {"grid", "octree", "kd_tree", "wide_bvh"}) {
            plans.push_back(structure_plan(structure, GNOMON_QUALITY_LOW, options));
            plans.push_back(structure_plan(structure, GNOMON_QUALITY_HIGH, options));
        }
    }
    for (Plan& plan : plans) {
        if (plan.build.structure == GNOMON_STRUCTURE_BSP_TREE) plan.timed = triangle_count <= few_triangles;
    }
    if (triangle_count > most_bsp_triangles)
        std::erase_if(plans, [](const Plan& plan) { return plan.build.structure == GNOMON_STRUCTURE_BSP_TREE; });
    return plans;
}

}  // namespace harness
