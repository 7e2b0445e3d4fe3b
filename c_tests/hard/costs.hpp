// What precision costs, and what invalid rays do.
#pragma once

#include <string>
#include <vector>

#include "hard/options.hpp"
#include "hard/results.hpp"

namespace harness {

/// The precisions asked for, interleaved, in the wide BVH on a few generated scenes and on those of GNOMON_SHARED_SCENES.
std::vector<PrecisionCost> measure_precision_costs(const HardOptions& options, std::vector<std::string>& notes);

/// Single calls, interleaved, in the wide BVH.
InvalidCost measure_invalid_cost(const HardOptions& options);

}  // namespace harness
