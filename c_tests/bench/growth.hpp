// How builds, memory and rays grow with the number of triangles.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/contenders.hpp"
#include "bench/options.hpp"
#include "bench/results.hpp"
#include "rays/rays.hpp"

namespace harness {

/// What a step of the build time may exceed n log n by: the scatter of the least of a few builds.
constexpr double growth_margin = 1.15;

/// Which scene grows, and what is measured on it.
struct GrowthCase {
    std::string generator;
    std::size_t first_step, last_step;  // powers of 10
    std::uint32_t most_build_repeats;
    std::string tracer;  // the contender that finds what rays start from
    std::function<std::vector<Plan>(std::size_t triangle_count)> plans;
    std::function<std::vector<Timing>(std::vector<Contender>&, const RaySet&, Progress&)> trace;
};

/// One row a contender and step.
std::vector<Growth> measure_steps(const GrowthCase& growth_case, const BenchOptions& options, std::vector<std::string>& notes);

/// 10^3, 10^4, ... triangles of the same hills, up to options.most_triangles; gnomon and Embree.
std::vector<Growth> measure_growth(const BenchOptions& options, std::vector<std::string>& notes);

}  // namespace harness
