#include "bench/structures/grid_sweep.hpp"

#include <algorithm>
#include <array>

#include "bench/structures/plans.hpp"
#include "bench/structures/trace_in_time.hpp"
#include "bench/views.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

/// Cells a triangle. The first comes to one cell for all; 27 is what is often taught; the last are far too many.
constexpr std::array resolutions = {1e-9, 0.01, 0.1, 1.0, 2.0, 6.0, 12.0, 27.0, 100.0, 300.0};
constexpr std::array quick_resolutions = {1e-9, 0.1, 1.0, 6.0, 27.0, 100.0};

std::vector<double> resolutions_for(const BenchOptions& options) {
    if (options.quick) return {quick_resolutions.begin(), quick_resolutions.end()};
    return {resolutions.begin(), resolutions.end()};
}

Plan grid_plan(double cells_per_triangle, const BenchOptions& options) {
    Plan plan = structure_plan("grid", GNOMON_QUALITY_MEDIUM, options);
    plan.name += " of " + figure(cells_per_triangle, "%g");
    plan.build.grid_cells_per_triangle = static_cast<float>(cells_per_triangle);
    return plan;
}

GridStep step_of(const BuildTiming& build, double asked, double triangle_count) {
    const BuildReport& report = build.report;
    return {asked,
            static_cast<double>(report.nodes) / triangle_count,
            static_cast<double>(report.references) / triangle_count,
            report.seconds,
            static_cast<double>(report.bytes) / triangle_count,
            {}};
}

}  // namespace

GridSweep sweep_grid(const Scene& scene, const BenchOptions& options, std::vector<std::string>& notes) {
    GridSweep sweep;
    sweep.scene = scene.name;
    sweep.triangle_count = scene.triangle_count();
    std::vector<Plan> plans = {structure_plan(reference_structure, GNOMON_QUALITY_MEDIUM, options)};
    for (const double asked : resolutions_for(options)) plans.push_back(grid_plan(asked, options));
    Progress progress(build_step_count(plans, options) + most_ray_sets * pass_count(options.repeats), "grids");
    std::vector<std::string> not_built;
    std::vector<Contender> contenders = build_contenders(scene, plans, options, progress, not_built, notes);
    const auto reference = find_contender(contenders, reference_structure);
    if (!reference) return sweep;

    std::vector<std::size_t> step_of_build(contenders.size());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        step_of_build[i] = sweep.steps.size();
        if (i == *reference) continue;
        const Contender& grid = contenders[i];
        const double asked = grid.plan.build.grid_cells_per_triangle;
        sweep.steps.push_back(step_of(grid.timing, asked, static_cast<double>(sweep.triangle_count)));
    }
    const Tracer tracer = tracer_of(*contenders[*reference].backend);
    const std::vector<View> outside = {bench_views(scene, tracer).front()};
    for (const ViewRays& rays : bench_rays(scene, outside, tracer, options.ray_count)) {
        if (rays.set.rays.empty()) continue;
        progress.set_label(scene.name + ": grids trace " + rays.set.kind + " rays");
        for (const Timing& timing : trace_in_time(contenders, rays.set, 0, options, progress)) {
            auto& figures =
                timing.build == *reference ? sweep.bvh_ns_per_ray : sweep.steps[step_of_build[timing.build]].ns_per_ray;
            figures.emplace_back(rays.set.kind, timing.ns_per_ray);
        }
    }
    return sweep;
}

}  // namespace harness
