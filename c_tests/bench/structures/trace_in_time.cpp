#include "bench/structures/trace_in_time.hpp"

#include <algorithm>

#include "bench/structures/plans.hpp"

namespace harness {
namespace {

/// Seconds that a contender may take for a pass over the rays.
double most_pass_seconds(const BenchOptions& options) { return options.quick ? 0.04 : 0.25; }

constexpr std::size_t sampled_rays = 16, fewest_rays = 100;

double trace_once(Backend& backend, const RaySet& set) {
    backend.prepare(set.rays);
    if (set.occlusion) {
        std::vector<std::uint8_t> occluded(set.rays.size());
        return backend.occluded(CallForm::fresh, occluded, 1);
    }
    std::vector<GnomonHit> hits(set.rays.size());
    return backend.intersect(CallForm::fresh, hits, 1);
}

RaySet thinned(const RaySet& set, std::size_t count) { return {set.kind, set.occlusion, spread_rays(set.rays, count)}; }

/// How many of the rays there is time for, by the second of two passes over a few of them.
std::size_t affordable_rays(Backend& backend, const RaySet& set, double pass_seconds) {
    const RaySet sample = thinned(set, sampled_rays);
    trace_once(backend, sample);
    const double seconds = trace_once(backend, sample) / static_cast<double>(sample.rays.size());
    const double affordable = std::max(pass_seconds / seconds, double{fewest_rays});
    return static_cast<std::size_t>(std::min(affordable, static_cast<double>(set.rays.size())));
}

}  // namespace

std::vector<Timing> trace_in_time(std::vector<Contender>& contenders, const RaySet& set, std::size_t ray_set,
                                  const BenchOptions& options, Progress& progress) {
    const std::size_t reference = find_contender(contenders, reference_structure).value();
    constexpr std::size_t first = 0;  // of the runs: the judge, set against itself too
    const Run judge{reference, CallForm::fresh, 1, first, true};
    std::vector<Run> quick = {judge}, slow;
    std::vector<std::size_t> slow_ray_counts;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        if (i == reference || !contenders[i].backend) continue;
        const std::size_t count = affordable_rays(*contenders[i].backend, set, most_pass_seconds(options));
        const bool in_time = 2 * count > set.rays.size();
        (in_time ? quick : slow).push_back({i, CallForm::fresh, 1, first});
        if (!in_time) slow_ray_counts.push_back(count);
    }
    std::vector<Timing> timings = trace_interleaved(contenders, quick, set, ray_set, options.repeats, progress);
    for (std::size_t i = 0; i < slow.size(); ++i) {
        const RaySet part = thinned(set, slow_ray_counts[i]);
        timings.push_back(trace_interleaved(contenders, {judge, slow[i]}, part, ray_set, options.repeats, progress)[1]);
    }
    return timings;
}

RaySet traced_part(const RaySet& set, const Timing& timing) { return thinned(set, timing.ray_count); }

}  // namespace harness
