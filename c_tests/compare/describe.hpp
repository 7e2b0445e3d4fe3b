// Answers and truths in words, for failures and replays.
#pragma once

#include <string>

#include "oracle/oracle.hpp"

namespace harness {

/// A ray as --replay takes it: origin, t_min, direction and t_max as eight hexadecimal floats with commas between them; bit for
/// bit.
std::string ray_text(const GnomonRay& ray);

/// "geometry 0, primitive 12, t 0x1.8p+1, u 0x1p-2, v 0x1p-3", or "miss".
std::string hit_text(const GnomonHit& hit);

/// The closest exact hits of the ray with their t, and how many more there are; or "miss".
std::string truth_text(const Oracle& oracle, const GnomonRay& ray);

/// "false hit, outside the contract", ...; "right" where nothing is wrong.
std::string verdict_text(const Verdict& verdict);

}  // namespace harness
