// The results on a terminal.
#pragma once

#include <string>
#include <vector>

#include "hard/results.hpp"

namespace harness {

/// A line for each group of engines whose figures are the same.
std::string population_text(const std::vector<PopulationRow>& rows);

/// A line for each case.
std::string case_text(const std::vector<CaseRow>& rows);

std::string bars_text(const std::vector<HardBar>& bars);

}  // namespace harness
