// How builds, memory and rays grow with the number of triangles.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"

namespace harness {

/// What a step of the build time may exceed n log n by: the scatter of the least of a few builds.
constexpr double growth_margin = 1.15;

/// 10^3, 10^4, ... triangles of the same hills, up to options.most_triangles; gnomon and Embree.
std::vector<Growth> measure_growth(const BenchOptions& options, std::vector<std::string>& notes);

}  // namespace harness
