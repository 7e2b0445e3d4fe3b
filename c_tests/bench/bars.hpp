// The table of bars: what performance.md asks for, what was measured, and whether it is enough.
#pragma once

#include <string>
#include <vector>

#include "bench/results.hpp"

namespace harness {

/// "Figures to beat" of performance.md, then those of growth and degenerate scenes. Rows of rays count the scenes from files, or
/// the generated ones where there is none from a file that is large enough; views that see next to nothing do not count.
std::vector<Bar> judge_bars(const BenchResults& results);

}  // namespace harness
