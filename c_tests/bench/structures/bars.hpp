// The bars of structures: what each must reach beside the scalar BVH, and how long its build may take.
#pragma once

#include <vector>

#include "bench/results.hpp"

namespace harness {

/// Ratios count scenes of 50,000 to 1,000,000 triangles and views that see more than next to nothing; builds are those of the
/// growth.
std::vector<Bar> judge_structure_bars(const StructureBench& structures);

}  // namespace harness
