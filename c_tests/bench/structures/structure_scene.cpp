#include "bench/structures/structure_scene.hpp"

#include "bench/contenders.hpp"
#include "bench/ray_work.hpp"
#include "bench/structures/plans.hpp"
#include "bench/structures/trace_in_time.hpp"
#include "bench/views.hpp"
#include "compare/text_table.hpp"

namespace harness {

StructureScene bench_structures(const Scene& scene, const BenchOptions& options, std::vector<std::string>& notes) {
    const auto qualities = options.quick ? Qualities::medium_alone : Qualities::all;
    const std::vector<Plan> plans = structure_plans(options, scene.triangle_count(), qualities);
    Progress progress(build_step_count(plans, options) + most_ray_sets * pass_count(options.repeats), scene.name);
    StructureScene result;
    SceneBench& bench = result.bench;
    bench.name = scene.name;
    bench.triangle_count = scene.triangle_count();
    if (scene.triangle_count() > most_bsp_triangles)
        notes.push_back(scene.name + ": without a BSP tree, built for " + grouped(most_bsp_triangles) + " triangles at most");
    std::vector<Contender> contenders = build_contenders(scene, plans, options, progress, bench.not_built, notes);
    for (const Contender& contender : contenders) bench.builds.push_back(contender.timing);
    const auto reference = find_contender(contenders, reference_structure);
    if (!reference) throw BuildError(GNOMON_ERROR_INTERNAL, scene.name + ": the BVH could not be built");

    Backend& backend = *contenders[*reference].backend;
    const Tracer tracer = tracer_of(backend);
    for (const auto& [view, set] : bench_rays(scene, bench_views(scene, tracer), tracer, options.ray_count)) {
        if (set.rays.empty()) {
            notes.push_back(scene.name + ", " + view + ": no " + set.kind + " rays");
            continue;
        }
        progress.set_label(scene.name + ": traces " + view + " " + set.kind + " rays");
        const std::size_t ray_set = bench.ray_sets.size();
        bench.ray_sets.push_back(ray_set_info(view, set, backend));
        for (const Timing& timing : trace_in_time(contenders, set, ray_set, options, progress)) {
            result.work.push_back(
                {ray_set, timing.build, mean_work(*contenders[timing.build].backend, traced_part(set, timing))});
            bench.timings.push_back(timing);
        }
    }
    return result;
}

}  // namespace harness
