// Speed of structures of which some are a thousand times slower than others.
#pragma once

#include <vector>

#include "bench/trace.hpp"

namespace harness {

/// Fresh calls of every contender, set against the reference structure, which also judges. All in one interleaved run over the
/// same rays; a contender too slow for that is traced on fewer of them, spread evenly, with the reference beside it.
std::vector<Timing> trace_in_time(std::vector<Contender>& contenders, const RaySet& set, std::size_t ray_set,
                                  const BenchOptions& options, Progress& progress);

/// The part of the set that a timing of trace_in_time() is about.
RaySet traced_part(const RaySet& set, const Timing& timing);

}  // namespace harness
