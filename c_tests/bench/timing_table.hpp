// The timings of a scene as a table: a row for each contender and call form, a column for each set of rays.
#pragma once

#include <functional>
#include <string>

#include "bench/results.hpp"
#include "compare/text_table.hpp"

namespace harness {

/// The text of a timing, "-" for none.
using TimingCell = std::function<std::string(const Timing&)>;

/// `heading` stands over the contenders. A row without a cell is left out.
TextTable timing_table(const SceneBench& scene, const std::string& heading, const TimingCell& cell);

std::string ratio_cell(const Timing& timing);
std::string ns_cell(const Timing& timing);

}  // namespace harness
