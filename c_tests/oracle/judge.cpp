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

/// Whether every engine within the contract takes the triangle for hit.
bool is_certain(const Candidate& c, Contract contract) {
    return c.exact_hit && std::isfinite(c.t_greatest) && (contract == Contract::exact || !c.in_band);
}

bool is_possible(const Candidate& c, Contract contract) { return c.exact_hit || contract == Contract::banded; }

/// Whether the float t of a certain hit lies in the interval, whichever way it was rounded.
bool surely_counts(const GnomonRay& ray, const Candidate& c, Contract contract) {
    return is_certain(c, contract) && in_interval(ray, c.t_least) && in_interval(ray, c.t_greatest);
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

bool answer_breaks_contract(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& candidates,
                            const Candidate* reported, const Verdict& verdict, Contract contract) {
    if (is_hit(answer)) {
        if (reported == nullptr || !is_possible(*reported, contract) || !in_interval(ray, answer.t)) return true;
        if (!(reported->t_least <= answer.t && answer.t <= reported->t_greatest)) return true;
        if (verdict.t_ulps > t_ulps_promised || verdict.uv_error > uv_error_promised) return true;
    }
    return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        return surely_counts(ray, c, contract) && (!is_hit(answer) || surely_beats(c, answer));
    });
}

bool occlusion_breaks_contract(const GnomonRay& ray, bool answer, const std::vector<Candidate>& candidates, Contract contract) {
    if (!answer) {
        return std::any_of(candidates.begin(), candidates.end(),
                           [&](const Candidate& c) { return surely_counts(ray, c, contract); });
    }
    return std::none_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        return is_possible(c, contract) && ray.t_min <= ray.t_max && ray.t_min <= c.t_greatest && c.t_least <= ray.t_max;
    });
}

}  // namespace

bool counts(const GnomonRay& ray, const Candidate& candidate) {
    return candidate.exact_hit && std::isfinite(candidate.t) && in_interval(ray, candidate.t);
}

Verdict judge_intersect(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& candidates,
                        const Candidate* reported, const std::optional<PlanePoint>& exact, Contract contract) {
    const auto closest = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) { return counts(ray, c); });
    const bool reported_counts = reported != nullptr && counts(ray, *reported);
    Verdict verdict;
    verdict.missed = !is_hit(answer) && closest != candidates.end();
    verdict.false_hit = is_hit(answer) && !reported_counts;
    verdict.wrong_primitive = reported_counts && reported->t > closest->t;
    verdict.tie = reported_counts && reported->t == closest->t && !same_triangle(answer, *closest);
    if (exact) {
        verdict.t_ulps = t_error_ulps(*exact, answer.t);
        verdict.uv_error = uv_error(*exact, answer);
    }
    verdict.outside_contract =
        contract != Contract::none && answer_breaks_contract(ray, answer, candidates, reported, verdict, contract);
    return verdict;
}

Verdict judge_occluded(const GnomonRay& ray, bool answer, const std::vector<Candidate>& candidates, Contract contract) {
    const bool truth = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) { return counts(ray, c); });
    Verdict verdict;
    verdict.missed = truth && !answer;
    verdict.false_hit = answer && !truth;
    verdict.outside_contract = contract != Contract::none && occlusion_breaks_contract(ray, answer, candidates, contract);
    return verdict;
}

}  // namespace harness
