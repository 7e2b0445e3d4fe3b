// The exact referee: brute force over all triangles with exact signs, independent of the library's arithmetic.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gnomon.h"
#include "scene/scene.hpp"

namespace harness {

/// What one triangle is to one ray.
struct Candidate {
    std::uint32_t geometry_id, primitive_id;
    bool exact_hit;  // the closed triangle and the line meet in one point: the exact signs say so
    bool in_band;    // an edge passes the ray within the band of accuracy.md: a decision in f32 may go either way
    float t;         // the exact t (a rational), rounded once to the nearest float; of the triangle's plane where it is no
                     // exact hit, +inf where the plane is parallel to the ray
    double t_exact;  // the same rational, rounded to double
    float t_least, t_greatest;  // which floats the contract allows for t: those within 0.51 ulp of an exact hit's; else all
                                // from the nearest to the farthest vertex, along the axis of the largest |direction|
};

/// What an engine did on one ray, against the truth. All raw judgements use the exact t rounded once, against a closed [t_min,
/// t_max]. A t that rounds to infinity is no hit: +inf is a miss's t.
struct Verdict {
    bool missed = false;            // there is an exact hit, the engine reported none
    bool false_hit = false;         // the triangle reported is not hit exactly, or not within the interval
    bool invented = false;          // the triangle reported is not hit, nor within the band of the ray
    bool wrong_primitive = false;   // it reported a true hit, but not the closest
    bool tie = false;               // it reported another triangle than the oracle's first, at the same rounded t: not wrong
    bool outside_contract = false;  // beyond what accuracy.md promises for the precision: see judge.cpp
    double t_ulps = -1;             // |t - exact t of the reported triangle| in ulps of the exact t's float
    double uv_error = -1;           // max(|u - exact|, |v - exact|) in units of 2^-24; both -1 without a true hit to compare
};

/// What the contract promises, by precision. `banded`: decisions in f32, t within 0.51 ulp. `exact`: no band, and the order of
/// the exact t; t rounded once, which is also what lies in the interval or not; so raw counts of 0.
enum class Contract { none, banded, exact };

class Oracle {
public:
    /// Refers to the scene, which must live as long. Triangles with a non-finite vertex are left out.
    explicit Oracle(const Scene& scene);
    explicit Oracle(Scene&&) = delete;
    ~Oracle();
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;

    /// All triangles that the ray hits or could be taken to hit in f32, sorted by the rational t, then by (geometry_id,
    /// primitive_id). Ignores the interval.
    std::vector<Candidate> candidates(const GnomonRay& ray) const;

    /// The same, asking every triangle: the check of the culling.
    std::vector<Candidate> candidates_unculled(const GnomonRay& ray) const;

    /// Exact hits with the rounded t in [t_min, t_max]; the closest first; empty for a miss or an invalid ray.
    std::vector<Candidate> hits(const GnomonRay& ray) const;

    /// Judges a closest-hit answer. `found` is what candidates() says of the ray, so that the answers of many engines share it.
    Verdict judge(const GnomonRay& ray, const GnomonHit& answer, Contract contract) const;
    Verdict judge(const GnomonRay& ray, const GnomonHit& answer, const std::vector<Candidate>& found, Contract contract) const;

    /// Judges an any-hit answer: missed, false_hit and outside_contract are filled.
    Verdict judge_occluded(const GnomonRay& ray, bool answer, Contract contract) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace harness
