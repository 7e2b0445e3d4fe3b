#include "oracle/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "oracle/rounding.hpp"

namespace harness {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_hit(const GnomonHit& answer) { return answer.geometry_id != GNOMON_INVALID_ID; }

bool same_triangle(const GnomonHit& answer, const Candidate& c) {
    return answer.geometry_id == c.geometry_id && answer.primitive_id == c.primitive_id;
}

bool precedes(const Candidate& c, const GnomonHit& answer) {
    return std::tie(c.geometry_id, c.primitive_id) < std::tie(answer.geometry_id, answer.primitive_id);
}

bool in_interval(const GnomonRay& ray, float t) { return ray.t_min <= t && t <= ray.t_max; }

/// Whether the band leaves no doubt that the triangle is hit, nor the rounding of its t that it lies in the interval.
bool surely_counts(const GnomonRay& ray, const Candidate& c) {
    const bool is_certain = c.exact_hit && !c.in_band && std::isfinite(c.t_greatest);
    return is_certain && in_interval(ray, c.t_least) && in_interval(ray, c.t_greatest);
}

/// Whether a candidate that surely counts comes before the answer: nearer however both were rounded, or at the same t, which
/// can be rounded in one way only, with the lower ids.
bool surely_beats(const Candidate& c, const GnomonHit& answer) {
    if (c.t_greatest < answer.t) return true;
    return c.t_least == c.t_greatest && c.t_least == answer.t && precedes(c, answer);
}

double t_error_ulps(const PlanePoint& exact, float t) {
    if (!std::isfinite(t)) return infinity;
    return nearest_double(abs(mpq_class(t) - exact.t) / mpq_class(float_spacing(exact.t)));
}

double uv_error(const PlanePoint& exact, const GnomonHit& answer) {
    if (!std::isfinite(answer.u) || !std::isfinite(answer.v)) return infinity;
    const mpq_class u_error = abs(mpq_class(answer.u) - exact.u);
    const mpq_class v_error = abs(mpq_class(answer.v) - exact.v);
    return nearest_double(std::max(u_error, v_error)) * 0x1p24;
}

/// Contract::banded: any candidate may be taken for hit, those that surely count have to be.
bool leaves_band(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& candidates,
                 const Candidate* reported, const Verdict& verdict) {
    if (is_hit(answer)) {
        if (reported == nullptr || !in_interval(ray, answer.t)) return true;
        if (!(reported->t_least <= answer.t && answer.t <= reported->t_greatest)) return true;
        if (verdict.t_ulps > t_ulps_promised || verdict.uv_error > uv_error_promised) return true;
    }
    return std::any_of(candidates.begin(), candidates.end(),
                       [&](const Candidate& c) { return surely_counts(ray, c) && (!is_hit(answer) || surely_beats(c, answer)); });
}

bool occlusion_leaves_band(const GnomonRay& ray, bool answer, const std::vector<Candidate>& candidates) {
    if (!answer)
        return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) { return surely_counts(ray, c); });
    return std::none_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        return ray.t_min <= ray.t_max && ray.t_min <= c.t_greatest && c.t_least <= ray.t_max;
    });
}

/// Contract::exact: one triangle is right, the first of the candidates that count, and one t.
bool is_inexact(const GnomonHit& answer, const Candidate* closest, const Verdict& verdict) {
    if (closest == nullptr) return is_hit(answer);
    return !same_triangle(answer, *closest) || answer.t != closest->t || verdict.uv_error > uv_error_promised;
}

}  // namespace

bool counts(const GnomonRay& ray, const Candidate& candidate) {
    return candidate.exact_hit && std::isfinite(candidate.t) && in_interval(ray, candidate.t);
}

Verdict judge_intersect(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& candidates,
                        const Candidate* reported, const std::optional<PlanePoint>& exact, Contract contract) {
    const auto first = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) { return counts(ray, c); });
    const Candidate* closest = first == candidates.end() ? nullptr : &*first;
    const bool reported_counts = reported != nullptr && counts(ray, *reported);
    Verdict verdict;
    verdict.missed = !is_hit(answer) && closest != nullptr;
    verdict.false_hit = is_hit(answer) && !reported_counts;
    verdict.invented = is_hit(answer) && reported == nullptr;
    verdict.wrong_primitive = reported_counts && reported->t > closest->t;
    verdict.tie = reported_counts && reported->t == closest->t && !same_triangle(answer, *closest);
    if (exact) {
        verdict.t_ulps = t_error_ulps(*exact, answer.t);
        verdict.uv_error = uv_error(*exact, answer);
    }
    if (contract == Contract::banded) verdict.outside_contract = leaves_band(ray, answer, candidates, reported, verdict);
    if (contract == Contract::exact) verdict.outside_contract = is_inexact(answer, closest, verdict);
    return verdict;
}

Verdict judge_occluded(const GnomonRay& ray, bool answer, const std::vector<Candidate>& candidates, Contract contract) {
    const bool truth = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) { return counts(ray, c); });
    Verdict verdict;
    verdict.missed = truth && !answer;
    verdict.false_hit = answer && !truth;
    verdict.invented = answer && candidates.empty();
    if (contract == Contract::banded) verdict.outside_contract = occlusion_leaves_band(ray, answer, candidates);
    if (contract == Contract::exact) verdict.outside_contract = answer != truth;
    return verdict;
}

}  // namespace harness
