// One population through every engine.
#pragma once

#include <vector>

#include "hard/failures.hpp"
#include "hard/populations.hpp"
#include "hard/results.hpp"

namespace harness {

/// One row an engine.
std::vector<PopulationRow> judge_population(const Population& population, const HardOptions& options,
                                            const std::vector<HardEngine>& engines, Failures& failures);

}  // namespace harness
