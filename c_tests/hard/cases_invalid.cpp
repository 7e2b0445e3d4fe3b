// Rays that are no rays, and intervals that are empty or behind the origin.
#include <limits>

#include "hard/cases.hpp"
#include "hard/invalid_rays.hpp"
#include "rays/aim.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void run_not_finite(CaseRun& run) {
    const Trial trial = soup_trial(0.3, run.ray_count(), run.rng);
    std::vector<GnomonRay> rays;
    for (std::size_t i = 0; i < trial.rays.size(); ++i)
        rays.push_back(invalid_rays()[i % invalid_rays().size()].spoil(trial.rays[i]));
    run.expect_misses(trial.scene, rays);
}

void run_empty_intervals(CaseRun& run) {
    const Trial trial = soup_trial(0.3, run.ray_count(2), run.rng);
    std::vector<GnomonRay> empty, backwards;
    for (const GnomonRay& ray : trial.rays) {
        GnomonRay without_direction = ray, reversed = ray, behind = ray, around = ray;
        std::ranges::fill(without_direction.direction, 0.0f);
        reversed.t_min = 2;
        reversed.t_max = 1;
        empty.insert(empty.end(), {without_direction, reversed});
        behind.t_max = -0.25f;  // after t_min = 0: empty
        empty.push_back(behind);
        behind.t_min = -infinity;
        around.t_min = -2;
        backwards.insert(backwards.end(), {behind, around});
    }
    run.expect_misses(trial.scene, empty);
    run.judge(trial.scene, backwards);
}

}  // namespace

std::vector<HardCase> invalid_ray_cases() {
    return {
        {31, "NaN and infinity in each of the ray's fields", "0 hits", run_not_finite},
        {33, "zero direction, empty and negative intervals", "0 wrong", run_empty_intervals},
    };
}

}  // namespace harness
