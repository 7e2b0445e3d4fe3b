// The results for a terminal.
#pragma once

#include <string>

#include "bench/results.hpp"

namespace harness {

std::string scene_text(const SceneBench& scene);
std::string call_cost_text(const std::vector<CallCost>& costs);
std::string growth_text(const std::vector<Growth>& steps);
std::string degenerate_text(const std::vector<Degenerate>& rows);
std::string bars_text(const std::vector<Bar>& bars, const std::string& heading);

}  // namespace harness
