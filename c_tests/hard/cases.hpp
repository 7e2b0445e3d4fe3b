// accuracy.md's hard cases, in its order.
#pragma once

#include <vector>

#include "hard/case_run.hpp"

namespace harness {

const std::vector<HardCase>& hard_cases();

// One file each.
std::vector<HardCase> closed_mesh_cases();  // 1 to 5, 7 to 10
std::vector<HardCase> aligned_cases();      // 11 to 17, 22: coordinates that meet exactly
std::vector<HardCase> interval_cases();     // 18, 19
std::vector<HardCase> shape_cases();        // 20, 21, 23 to 25, 35
std::vector<HardCase> symmetry_cases();     // 26 to 29
std::vector<HardCase> range_cases();        // 30, 32: small and large coordinates, and what is no number
std::vector<HardCase> invalid_ray_cases();  // 31, 33
std::vector<HardCase> crowd_cases();        // 34, 36 to 39
std::vector<HardCase> agreement_cases();    // 40
std::vector<HardCase> walk_cases();         // 6, 41: from hit to hit
std::vector<HardCase> report_cases();       // 42

}  // namespace harness
