// What a call costs where there is next to nothing to trace.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"

namespace harness {

/// Fresh single calls on an empty scene and on one triangle that every ray hits.
std::vector<CallCost> measure_call_costs(const BenchOptions& options);

}  // namespace harness
