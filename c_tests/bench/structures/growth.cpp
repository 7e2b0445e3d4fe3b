#include "bench/structures/growth.hpp"

#include <algorithm>

#include "bench/growth.hpp"
#include "bench/structures/plans.hpp"
#include "bench/structures/trace_in_time.hpp"

namespace harness {
namespace {

constexpr std::size_t last_step = 1'000'000, last_quick_step = 100'000;

}  // namespace

std::vector<Growth> measure_structure_growth(const BenchOptions& options, std::vector<std::string>& notes) {
    const std::size_t last = std::min(options.quick ? last_quick_step : last_step, options.most_triangles);
    GrowthCase soup{"soup", 100, last, options.build_repeats, reference_structure, {}, {}};
    soup.plans = [&](std::size_t count) { return structure_plans(options, count, Qualities::medium_alone); };
    soup.trace = [&](std::vector<Contender>& contenders, const RaySet& set, Progress& progress) {
        return trace_in_time(contenders, set, 0, options, progress);
    };
    return measure_steps(soup, options, notes);
}

}  // namespace harness
