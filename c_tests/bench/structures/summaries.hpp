// Which structure when, in a sentence each.
#pragma once

#include <vector>

#include "bench/results.hpp"

namespace harness {

// Scenes, by their names, that show what a grid is for and what it is not for.
inline constexpr const char *evenly_spread_scene = "soup", *unevenly_spread_scene = "teapot_in_stadium";

/// What the literature says of each structure, and the scenes on which it did best and worst; then which was the fastest where.
std::vector<StructureSummary> summarize_structures(const StructureBench& structures);

}  // namespace harness
