// What a degenerate scene costs: its build, and its worst ray.
#pragma once

#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"

namespace harness {

/// gnomon and Embree on each of degenerate_scenes(), 10^6 triangles or options.most_triangles. Neither a build nor the rays of a
/// scene may take longer than a guard allows: a row then says so, or counts fewer rays.
std::vector<Degenerate> measure_degenerate(const BenchOptions& options);

}  // namespace harness
