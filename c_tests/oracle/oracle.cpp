#include "oracle/oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "oracle/cull.hpp"
#include "oracle/exact.hpp"
#include "oracle/filter.hpp"
#include "oracle/judge.hpp"
#include "oracle/ray_frame.hpp"
#include "oracle/rounding.hpp"

namespace harness {
namespace {

bool signs_are_known(const std::array<EdgeEstimate, 3>& edges) {
    return std::all_of(edges.begin(), edges.end(), [](const EdgeEstimate& edge) { return edge.sign_is_known(); });
}

constexpr float infinity = std::numeric_limits<float>::infinity();

void allow_rounding(Candidate& candidate) {
    const double reach = t_ulps_promised * float_spacing(candidate.t_exact);
    const auto neighbour_or_nearest = [&](float towards) {
        const float neighbour = std::nextafter(candidate.t, towards);
        return std::abs(neighbour - candidate.t_exact) <= reach ? neighbour : candidate.t;
    };
    candidate.t_least = neighbour_or_nearest(-infinity);
    candidate.t_greatest = neighbour_or_nearest(infinity);
}

void allow_depths(Candidate& candidate, const RayFrame& frame, const Triangle& triangle) {
    const auto t_of = [&](const Vec3f& vertex) {
        return static_cast<float>((static_cast<double>(vertex[2]) - frame.origin[2]) / frame.direction[2]);
    };
    const auto [least, greatest] = std::minmax({t_of(triangle[0]), t_of(triangle[1]), t_of(triangle[2])});
    // Two roundings in double and one in float, or the library's: one float to either side.
    candidate.t_least = std::nextafter(least, -infinity);
    candidate.t_greatest = std::nextafter(greatest, infinity);
}

/// Nothing for a triangle that neither exact arithmetic nor f32 could take for hit.
std::optional<Candidate> classify(const RayFrame& frame, const StoredTriangle& stored) {
    const Triangle triangle = frame.rename(stored.vertices);
    const auto edges = estimate_edges(frame, triangle);
    if (!edges) return std::nullopt;

    const ExactPair pair(frame, triangle);
    const bool exact_hit = is_hit(signs_are_known(*edges) ? std::array{(*edges)[0].sign(), (*edges)[1].sign(), (*edges)[2].sign()}
                                                          : pair.edge_signs());
    if (!exact_hit && has_zero_area(triangle)) return std::nullopt;

    const bool in_band = std::any_of(edges->begin(), edges->end(), [](const EdgeEstimate& edge) { return edge.in_band(); });
    Candidate candidate{stored.geometry_id, stored.primitive_id, exact_hit, in_band, infinity, infinity, -infinity, infinity};
    if (const auto t = pair.plane_t()) {
        candidate.t = nearest_float(*t);
        candidate.t_exact = nearest_double(*t);
    }
    if (exact_hit) {
        allow_rounding(candidate);
    } else {
        allow_depths(candidate, frame, triangle);
    }
    return candidate;
}

void sort_by_t(std::vector<Candidate>& candidates) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.t, a.geometry_id, a.primitive_id) < std::tie(b.t, b.geometry_id, b.primitive_id);
    });
}

/// The candidates among the triangles that for_each(visit) visits, none of a ray that is no line.
template <typename ForEach>
std::vector<Candidate> collect(const GnomonRay& ray, ForEach&& for_each) {
    const RayFrame frame(ray);
    if (!frame.is_line()) return {};
    std::vector<Candidate> found;
    for_each([&](const StoredTriangle& triangle) {
        if (const auto candidate = classify(frame, triangle)) found.push_back(*candidate);
    });
    sort_by_t(found);
    return found;
}

}  // namespace

struct Oracle::State {
    const Scene& scene;
    CullTree tree;
};

Oracle::Oracle(const Scene& scene) : state_(new State{scene, CullTree(scene)}) {}
Oracle::~Oracle() = default;

std::vector<Candidate> Oracle::candidates(const GnomonRay& ray) const {
    return collect(ray, [&](auto&& visit) { state_->tree.for_each_near(Line(ray), visit); });
}

std::vector<Candidate> Oracle::candidates_unculled(const GnomonRay& ray) const {
    return collect(ray, [&](auto&& visit) {
        for (const StoredTriangle& triangle : state_->tree.triangles()) visit(triangle);
    });
}

std::vector<Candidate> Oracle::hits(const GnomonRay& ray) const {
    std::vector<Candidate> found = candidates(ray);
    std::erase_if(found, [&](const Candidate& candidate) { return !counts(ray, candidate); });
    return found;
}

Verdict Oracle::judge(const GnomonRay& ray, const GnomonHit& answer, Contract contract) const {
    return judge(ray, answer, candidates(ray), contract);
}

Verdict Oracle::judge(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& found,
                      Contract contract) const {
    const auto reported = std::find_if(found.begin(), found.end(), [&](const Candidate& candidate) {
        return candidate.geometry_id == answer.geometry_id && candidate.primitive_id == answer.primitive_id;
    });
    if (reported == found.end()) return judge_intersect(ray, answer, found, nullptr, std::nullopt, contract);
    std::optional<PlanePoint> exact;
    if (reported->exact_hit) {
        const RayFrame frame(ray);
        const Triangle triangle = state_->scene.triangle(answer.geometry_id, answer.primitive_id);
        exact = ExactPair(frame, frame.rename(triangle)).plane_point();
    }
    return judge_intersect(ray, answer, found, &*reported, exact, contract);
}

Verdict Oracle::judge_occluded(const GnomonRay& ray, bool answer, Contract contract) const {
    return harness::judge_occluded(ray, answer, candidates(ray), contract);
}

}  // namespace harness
