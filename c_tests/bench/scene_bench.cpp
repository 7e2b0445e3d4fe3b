#include "bench/scene_bench.hpp"

#include "bench/contenders.hpp"
#include "bench/ray_work.hpp"
#include "bench/trace.hpp"
#include "bench/views.hpp"

namespace harness {
namespace {

/// Rays of a batch to those of the single calls: an image as dense as packets are meant for, and enough for threads that take
/// milliseconds to come apart.
constexpr std::size_t batch_factor = 5;

void append(std::vector<Timing>& to, const std::vector<Timing>& from) { to.insert(to.end(), from.begin(), from.end()); }

}  // namespace

SceneBench bench_scene(const Scene& scene, const BenchOptions& options, std::vector<std::string>& notes) {
    const std::vector<Plan> plans = bench_plans(options);
    Progress progress(build_step_count(plans, options) + 2 * most_ray_sets * pass_count(options.repeats), scene.name);
    SceneBench bench;
    bench.name = scene.name;
    bench.triangle_count = scene.triangle_count();
    std::vector<Contender> contenders = build_contenders(scene, plans, options, progress, bench.not_built, notes);
    for (const Contender& contender : contenders) bench.builds.push_back(contender.timing);
    const auto gnomon = find_contender(contenders, "gnomon");
    if (!gnomon) throw BuildError(GNOMON_ERROR_INTERNAL, scene.name + ": gnomon could not build it");

    Backend& backend = *contenders[*gnomon].backend;
    const Tracer tracer = tracer_of(backend);
    const std::vector<View> views = bench_views(scene, tracer);
    const std::vector<ViewRays> singles = bench_rays(scene, views, tracer, options.ray_count);
    const std::vector<ViewRays> batches = bench_rays(scene, views, tracer, options.ray_count * batch_factor);
    for (std::size_t i = 0; i < singles.size(); ++i) {
        const auto& [view, set] = singles[i];
        const RaySet& batch = batches[i].set;
        if (set.rays.empty()) {
            notes.push_back(scene.name + ", " + view + ": no " + set.kind + " rays");
            continue;
        }
        progress.set_label(scene.name + ": traces " + view + " " + set.kind + " rays");
        const std::size_t ray_set = bench.ray_sets.size();
        bench.ray_sets.push_back(ray_set_info(view, set, backend));
        bench.ray_sets.back().batch_ray_count = batch.rays.size();
        append(bench.timings, trace_interleaved(contenders, single_runs(contenders), set, ray_set, options.repeats, progress));
        append(bench.timings, trace_interleaved(contenders, batch_runs(contenders, batch, options.threads), batch, ray_set,
                                                options.repeats, progress));
    }
    return bench;
}

}  // namespace harness
