#include "bench/growth.hpp"

#include <algorithm>
#include <cmath>

#include "bench/trace.hpp"
#include "bench/views.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr std::size_t outside_ray_sets = 4;

/// Small builds are short: more of them to find the least.
std::uint32_t build_repeats_of(std::size_t triangle_count) {
    return triangle_count <= 10'000 ? 20 : triangle_count <= 1'000'000 ? 5 : 2;
}

std::vector<Plan> growth_plans(const BenchOptions& options) {
    std::vector<Plan> plans = bench_plans(options);
    std::erase_if(plans, [](const Plan& plan) { return plan.name != "gnomon" && plan.name != "embree"; });
    return plans;
}

double n_log_n(std::size_t n) { return static_cast<double>(n) * std::log2(static_cast<double>(n)); }

/// Holds a step against the last one of the same engine.
void compare_with_step_before(Growth& growth, const std::vector<Growth>& steps) {
    for (const Growth& before : steps) {
        if (before.engine != growth.engine) continue;
        growth.step = growth.build_seconds / before.build_seconds;
        growth.n_log_n_step = n_log_n(growth.triangle_count) / n_log_n(before.triangle_count);
        growth.within_n_log_n = growth.step <= growth_margin * growth.n_log_n_step;
    }
}

void measure_step(const GrowthCase& growth_case, std::size_t triangle_count, const BenchOptions& options,
                  std::vector<Growth>& steps, std::vector<std::string>& notes) {
    const Scene scene = generate_scene(growth_case.generator, triangle_count);
    const std::vector<Plan> plans = growth_case.plans(triangle_count);
    Progress progress(build_step_count(plans, options) + outside_ray_sets * pass_count(options.repeats), "growth");
    std::vector<std::string> not_built;
    std::vector<Contender> contenders = build_contenders(scene, plans, options, progress, not_built, notes);
    const auto tracing = find_contender(contenders, growth_case.tracer);
    if (!tracing) return;

    std::vector<Growth> step;
    for (const Contender& contender : contenders) {
        const BuildReport& report = contender.timing.report;
        Growth growth;
        growth.engine = contender.plan.name;
        growth.triangle_count = scene.triangle_count();
        growth.build_seconds = contender.timing.least_seconds;
        growth.bytes_per_triangle = static_cast<double>(report.bytes) / static_cast<double>(scene.triangle_count());
        compare_with_step_before(growth, steps);
        step.push_back(growth);
    }
    const Tracer tracer = tracer_of(*contenders[*tracing].backend);
    const std::vector<View> outside = {bench_views(scene, tracer).front()};
    for (const ViewRays& rays : bench_rays(scene, outside, tracer, options.ray_count)) {
        progress.set_label("growth: traces " + rays.set.kind + " rays");
        if (rays.set.rays.empty()) continue;
        for (const Timing& timing : growth_case.trace(contenders, rays.set, progress)) {
            step[timing.build].ns_per_ray.emplace_back(rays.set.kind, timing.ns_per_ray);
        }
    }
    steps.insert(steps.end(), step.begin(), step.end());
}

}  // namespace

std::vector<Growth> measure_steps(const GrowthCase& growth_case, const BenchOptions& options, std::vector<std::string>& notes) {
    std::vector<Growth> steps;
    for (std::size_t count = growth_case.first_step; count <= growth_case.last_step; count *= 10) {
        BenchOptions step_options = options;
        step_options.build_repeats = std::min(build_repeats_of(count), growth_case.most_build_repeats);
        measure_step(growth_case, count, step_options, steps, notes);
    }
    return steps;
}

std::vector<Growth> measure_growth(const BenchOptions& options, std::vector<std::string>& notes) {
    GrowthCase hills{"terrain", 1'000, options.most_triangles, 20, "gnomon", {}, {}};
    hills.plans = [&](std::size_t) { return growth_plans(options); };
    hills.trace = [&](std::vector<Contender>& contenders, const RaySet& set, Progress& progress) {
        return trace_interleaved(contenders, fresh_runs(contenders), set, 0, options.repeats, progress);
    };
    return measure_steps(hills, options, notes);
}

}  // namespace harness
