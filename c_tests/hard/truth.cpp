#include "hard/truth.hpp"

#include <algorithm>
#include <cstring>

#include "compare/describe.hpp"
#include "harness/parallel_for.hpp"
#include "oracle/judge.hpp"

namespace harness {
namespace {

bool is_same_triangle(const Candidate& c, const GnomonHit& hit) {
    return c.geometry_id == hit.geometry_id && c.primitive_id == hit.primitive_id;
}

/// The fields that are judged: the normal is none of them.
bool is_same_answer(const GnomonHit& a, const GnomonHit& b) {
    return a.geometry_id == b.geometry_id && a.primitive_id == b.primitive_id && std::memcmp(&a.t, &b.t, sizeof a.t) == 0 &&
           std::memcmp(&a.u, &b.u, sizeof a.u) == 0 && std::memcmp(&a.v, &b.v, sizeof a.v) == 0;
}

}  // namespace

Truth::Truth(const Scene& scene, const std::vector<GnomonRay>& rays)
    : rays_(rays), oracle_(scene), candidates_(rays.size()), judged_(rays.size()) {
    parallel_for(rays.size(), [&](std::size_t i) { candidates_[i] = oracle_.candidates(rays[i]); });
}

bool Truth::is_beaten(std::size_t ray, const GnomonHit& answer) const {
    const std::vector<Candidate>& all = candidates_[ray];
    const auto answered = std::ranges::find_if(all, [&](const Candidate& c) { return is_same_triangle(c, answer); });
    return answered != all.end() &&
           std::ranges::any_of(all, [&](const Candidate& c) { return counts(rays_[ray], c) && c.t_exact < answered->t_exact; });
}

std::vector<Verdict> Truth::judge(const std::vector<GnomonHit>& hits, Contract contract) {
    std::vector<Verdict> verdicts(hits.size());
    parallel_for(hits.size(), [&](std::size_t i) { verdicts[i] = judge_one(i, hits[i], contract); });
    return verdicts;
}

std::string Truth::describe(std::size_t ray, const GnomonHit& answer, const Verdict& verdict) const {
    return verdict_text(verdict) + "\n  gnomon  " + hit_text(answer) + "\n  exact   " + truth_text(oracle_, rays_[ray]);
}

Verdict Truth::judge_one(std::size_t ray, const GnomonHit& answer, Contract contract) {
    const auto known = std::ranges::find_if(
        judged_[ray], [&](const Judged& j) { return j.contract == contract && is_same_answer(j.answer, answer); });
    if (known != judged_[ray].end()) return known->verdict;
    const Verdict verdict = oracle_.judge(rays_[ray], answer, candidates_[ray], contract);
    judged_[ray].push_back({answer, contract, verdict});
    return verdict;
}

}  // namespace harness
