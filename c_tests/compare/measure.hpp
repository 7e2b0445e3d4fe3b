// Speed: every engine over the same rays, interleaved.
#pragma once

#include <string>
#include <vector>

#include "compare/engines.hpp"
#include "compare/results.hpp"
#include "rays/rays.hpp"

namespace harness {

/// Calls of one engine in one form that a measurement makes: a warm-up and the repeats.
inline std::size_t passes(const Options& options) { return 1 + options.repeats; }

/// One Speed an engine and call form. Brute force gets a part of the rays where all would take too long: a line in `warnings`
/// says so.
std::vector<Speed> measure(std::vector<Engine>& engines, const RaySet& set, const Options& options, Progress& progress,
                           std::vector<std::string>& warnings);

}  // namespace harness
