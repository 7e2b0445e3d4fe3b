// How fine a grid should be: from one cell to far too many.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"
#include "scene/scene.hpp"

namespace harness {

/// Seen from outside, and at random.
GridSweep sweep_grid(const Scene& scene, const BenchOptions& options, std::vector<std::string>& notes);

}  // namespace harness
