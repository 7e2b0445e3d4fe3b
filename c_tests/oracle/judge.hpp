// Verdicts: an engine's answer against all candidates of its ray.
#pragma once

#include <optional>
#include <vector>

#include "gnomon.h"
#include "oracle/exact.hpp"
#include "oracle/oracle.hpp"

namespace harness {

/// How far t may be off at most, in ulps: accuracy.md, ACCURATE and EXACT.
constexpr double t_ulps_promised = 0.51;

/// The same for u and v, in units of 2^-24.
constexpr double uv_error_promised = 0.52;

/// Whether a candidate is a true hit in the closed interval of the ray.
bool counts(const GnomonRay& ray, const Candidate& candidate);

/// `reported` is the candidate that the answer names, if any, and `exact` its exact point if it is an exact hit.
Verdict judge_intersect(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& candidates,
                        const Candidate* reported, const std::optional<PlanePoint>& exact, Contract contract);

Verdict judge_occluded(const GnomonRay& ray, bool answer, const std::vector<Candidate>& candidates, Contract contract);

}  // namespace harness
