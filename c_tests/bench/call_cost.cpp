#include "bench/call_cost.hpp"

#include <limits>

#include "backend/names.hpp"
#include "bench/contenders.hpp"
#include "bench/statistics.hpp"
#include "harness/rng.hpp"

namespace harness {
namespace {

constexpr std::size_t ray_count = 20'000, pass_count = 40;

/// Straight down on random points of the triangle below.
std::vector<GnomonRay> rays_at_triangle() {
    Rng rng(1);
    std::vector<GnomonRay> rays(ray_count);
    for (GnomonRay& ray : rays) {
        const double u = rng.uniform(0.01, 0.98), v = rng.uniform(0.01, 0.99 - u);
        ray = {{static_cast<float>(u), static_cast<float>(v), 1}, 0, {0, 0, -1}, std::numeric_limits<float>::infinity()};
    }
    return rays;
}

/// gnomon in each structure that makes sense for a triangle, then Embree.
std::vector<Plan> call_plans(const BenchOptions& options) {
    std::vector<Plan> plans;
    for (const Plan& plan : bench_plans(options)) {
        if (plan.name == "embree") plans.push_back(plan);
        if (plan.name != "gnomon") continue;
        for (const std::uint32_t structure : {GNOMON_STRUCTURE_AUTO, GNOMON_STRUCTURE_BRUTE_FORCE, GNOMON_STRUCTURE_WIDE_BVH}) {
            plans.push_back(plan);
            plans.back().name += " " + name_of(structure_names, structure);
            plans.back().build.structure = structure;
        }
    }
    return plans;
}

}  // namespace

std::vector<CallCost> measure_call_costs(const BenchOptions& options) {
    const std::vector<Scene> scenes = {{"empty", {}}, {"one triangle", {{"", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}}}};
    const std::vector<Plan> plans = call_plans(options);
    const std::vector<GnomonRay> rays = rays_at_triangle();
    std::vector<GnomonHit> hits(rays.size());
    std::vector<CallCost> costs;
    Progress progress(scenes.size() * pass_count, "calls");
    for (const Scene& scene : scenes) {
        std::vector<std::unique_ptr<Backend>> backends;
        for (const Plan& plan : plans) {
            backends.push_back(build_plan(scene, plan));
            backends.back()->prepare(rays);
        }
        std::vector<std::vector<double>> nanoseconds(plans.size());
        for (std::size_t pass = 0; pass < pass_count; ++pass) {
            for (std::size_t i = 0; i < plans.size(); ++i) {
                const double seconds = backends[i]->intersect(CallForm::fresh, hits, 1);
                nanoseconds[i].push_back(seconds * 1e9 / static_cast<double>(rays.size()));
            }
            progress.advance();
        }
        for (std::size_t i = 0; i < plans.size(); ++i) {
            costs.push_back({scene.name, plans[i].name, least(nanoseconds[i]), median(nanoseconds[i])});
        }
    }
    return costs;
}

}  // namespace harness
