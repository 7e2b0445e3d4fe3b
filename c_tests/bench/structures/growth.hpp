// How every structure grows with the number of triangles.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"

namespace harness {

/// An evenly spread soup of 10^2, 10^3, ... triangles, up to 10^6 (quick: 10^5) or options.most_triangles.
std::vector<Growth> measure_structure_growth(const BenchOptions& options, std::vector<std::string>& notes);

}  // namespace harness
