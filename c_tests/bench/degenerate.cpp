#include "bench/degenerate.hpp"

#include <algorithm>

#include "backend/trace_loop.hpp"
#include "bench/contenders.hpp"
#include "rays/degenerate_scenes.hpp"

namespace harness {
namespace {

constexpr std::size_t most_triangles = 1'000'000, ray_count = 2'000;
constexpr double most_build_seconds = 20, most_trace_seconds = 3;

/// Each ray's least time of a few passes, so that an interrupt is no ray's fault.
constexpr std::size_t pass_count = 3;

bool before_deadline(void* start, double) { return seconds_since(*static_cast<Clock::time_point*>(start)) < most_build_seconds; }

/// Nothing where the build has failed; `row` then says why.
std::unique_ptr<Backend> build_in_time(const Scene& scene, Plan plan, Degenerate& row) {
    Clock::time_point start = Clock::now();
    plan.build.progress = before_deadline;
    plan.build.progress_user = &start;
    try {
        return build_plan(scene, plan);
    } catch (const BuildError& error) {
        row.failure = error.what();
        return nullptr;
    }
}

/// Seconds of each ray, for as many rays as there is time for.
std::vector<double> time_rays(Backend& backend, const std::vector<GnomonRay>& rays) {
    std::vector<double> least;
    const Clock::time_point start = Clock::now();
    for (std::size_t i = 0; i < rays.size() && seconds_since(start) < most_trace_seconds; ++i) {
        GnomonHit hit;
        backend.prepare(std::span(&rays[i], 1));
        double seconds = backend.intersect(CallForm::fresh, std::span(&hit, 1), 1);
        for (std::size_t pass = 1; pass < pass_count; ++pass) {
            seconds = std::min(seconds, backend.intersect(CallForm::fresh, std::span(&hit, 1), 1));
        }
        least.push_back(seconds);
    }
    return least;
}

Degenerate measure_one(const DegenerateScene& kind, const Scene& scene, const Plan& plan) {
    Degenerate row;
    row.scene = kind.name;
    row.engine = plan.name;
    row.triangle_count = scene.triangle_count();
    const std::unique_ptr<Backend> backend = build_in_time(scene, plan, row);
    if (!backend) return row;
    row.build_seconds = backend->report().seconds;
    const std::vector<double> seconds = time_rays(*backend, degenerate_rays(scene, ray_count));
    row.ray_count = seconds.size();
    for (const double second : seconds) {
        row.mean_us += second * 1e6 / static_cast<double>(seconds.size());
        row.worst_us = std::max(row.worst_us, second * 1e6);
    }
    return row;
}

}  // namespace

std::vector<Degenerate> measure_degenerate(const BenchOptions& options) {
    std::vector<Plan> plans = bench_plans(options);
    std::erase_if(plans, [](const Plan& plan) { return plan.name != "gnomon" && plan.name != "embree"; });
    std::vector<Degenerate> rows;
    Progress progress(degenerate_scenes().size() * plans.size(), "degenerate scenes");
    for (const DegenerateScene& kind : degenerate_scenes()) {
        const Scene scene = kind.make(std::min(most_triangles, options.most_triangles));
        progress.set_label(kind.name);
        for (const Plan& plan : plans) {
            rows.push_back(measure_one(kind, scene, plan));
            progress.advance();
        }
    }
    return rows;
}

}  // namespace harness
