// accuracy.md's bars, each with what was measured.
#pragma once

#include <vector>

#include "hard/results.hpp"

namespace harness {

/// Bars of what did not run are left out.
std::vector<HardBar> judge_hard_bars(const HardResults& results);

/// Whether all bars of correctness are kept.
bool is_correct(const std::vector<HardBar>& bars);

}  // namespace harness
