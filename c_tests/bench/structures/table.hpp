// What was measured of structures, for a terminal.
#pragma once

#include <string>
#include <vector>

#include "bench/results.hpp"

namespace harness {

std::string structure_scene_text(const StructureScene& scene);
std::string grid_sweep_text(const GridSweep& sweep);
std::string structure_growth_text(const std::vector<Growth>& steps);
std::string summaries_text(const std::vector<StructureSummary>& summaries);

}  // namespace harness
