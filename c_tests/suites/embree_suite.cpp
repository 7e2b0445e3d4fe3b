// gnomon beside Embree on ordinary rays: wherever they disagree, the exact oracle must find gnomon within its contract.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "backend/backend.hpp"
#include "compare/describe.hpp"
#include "oracle/oracle.hpp"
#include "rays/rays.hpp"
#include "scene/load.hpp"

namespace {

using namespace harness;

constexpr std::size_t triangle_count = 2'000, ray_count = 5'000;
constexpr std::uint32_t threads = 1;

std::unique_ptr<Backend> make_accurate(const Scene& scene) {
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.precision = GNOMON_PRECISION_ACCURATE;
    options.thread_count = threads;
    return make_gnomon(scene, options);
}

std::vector<GnomonHit> intersect(Backend& backend, const RaySet& set) {
    std::vector<GnomonHit> hits(set.rays.size());
    backend.prepare(set.rays);
    backend.intersect(CallForm::fresh, hits, threads);
    return hits;
}

std::vector<std::uint8_t> occluded(Backend& backend, const RaySet& set) {
    std::vector<std::uint8_t> answers(set.rays.size());
    backend.prepare(set.rays);
    backend.occluded(CallForm::fresh, answers, threads);
    return answers;
}

bool same_triangle(const GnomonHit& a, const GnomonHit& b) {
    return a.geometry_id == b.geometry_id && (a.geometry_id == GNOMON_INVALID_ID || a.primitive_id == b.primitive_id);
}

bool is_right(const Verdict& verdict) { return !verdict.missed && !verdict.false_hit && !verdict.wrong_primitive; }

/// What came of a comparison; printed, as a count that changes is worth seeing.
struct Tally {
    std::size_t rays = 0, hits = 0, disagreements = 0, gnomon_wrong = 0, embree_wrong = 0;

    void judge(const Verdict& gnomon, const Verdict& embree) {
        ++disagreements;
        gnomon_wrong += !is_right(gnomon);
        embree_wrong += !is_right(embree);
    }
    void print(const std::string& what) const {
        MESSAGE(what << ": " << rays << " rays, " << hits << " hits, " << disagreements
                     << " disagreements; exactly wrong: gnomon " << gnomon_wrong << ", Embree " << embree_wrong);
    }
};

Tally compare_hits(const RaySet& set, const std::vector<GnomonHit>& ours, const std::vector<GnomonHit>& theirs,
                   const Oracle& oracle) {
    Tally tally;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        ++tally.rays;
        tally.hits += ours[i].geometry_id != GNOMON_INVALID_ID;
        if (same_triangle(ours[i], theirs[i])) continue;
        const Verdict verdict = oracle.judge(set.rays[i], ours[i], Contract::banded);
        tally.judge(verdict, oracle.judge(set.rays[i], theirs[i], Contract::none));
        INFO("ray ", ray_text(set.rays[i]), "; gnomon: ", hit_text(ours[i]), "; Embree: ", hit_text(theirs[i]),
             "; exact: ", truth_text(oracle, set.rays[i]));
        CHECK_FALSE(verdict.outside_contract);
    }
    return tally;
}

Tally compare_occlusion(const RaySet& set, const std::vector<std::uint8_t>& ours, const std::vector<std::uint8_t>& theirs,
                        const Oracle& oracle) {
    Tally tally;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        ++tally.rays;
        tally.hits += ours[i];
        if (ours[i] == theirs[i]) continue;
        const Verdict verdict = oracle.judge_occluded(set.rays[i], ours[i] != 0, Contract::banded);
        tally.judge(verdict, oracle.judge_occluded(set.rays[i], theirs[i] != 0, Contract::none));
        INFO("ray ", ray_text(set.rays[i]), "; gnomon: ", int(ours[i]), "; Embree: ", int(theirs[i]),
             "; exact: ", truth_text(oracle, set.rays[i]));
        CHECK_FALSE(verdict.outside_contract);
    }
    return tally;
}

std::vector<RaySet> ordinary_rays(const Scene& scene, Backend& tracer) {
    RaySet primary = primary_rays(outside_camera(scene), ray_count);
    const std::vector<GnomonHit> hits = intersect(tracer, primary);
    return {bounce_rays(scene, primary, hits, ray_count, 1), shadow_rays(scene, primary, hits, ray_count, 2),
            random_rays(scene, ray_count, 3), std::move(primary)};
}

void compare_engines(bool robust) {
    if (embree_version().empty()) {
        MESSAGE("skipped: built without Embree");
        return;
    }
    for (const GeneratorInfo& generator : generators()) {
        // Every hit of coinciding triangles is a tie, which Embree breaks as it likes: nothing to learn, at the price of a
        // judgement a ray.
        if (generator.name == "identical") continue;
        CAPTURE(generator.name);
        const Scene scene = generate_scene(generator.name, triangle_count);
        const Oracle oracle(scene);
        const auto gnomon = make_accurate(scene);
        const auto embree = make_embree(scene, robust, GNOMON_QUALITY_MEDIUM, threads);
        std::size_t hit_count = 0;
        for (const RaySet& set : ordinary_rays(scene, *gnomon)) {
            const Tally tally = set.occlusion ? compare_occlusion(set, occluded(*gnomon, set), occluded(*embree, set), oracle)
                                              : compare_hits(set, intersect(*gnomon, set), intersect(*embree, set), oracle);
            tally.print(generator.name + ", " + set.kind);
            hit_count += tally.hits;
        }
        CHECK(hit_count > 0);
    }
}

}  // namespace

TEST_CASE("gnomon_beside_embree_default_is_within_its_contract_at_every_disagreement") { compare_engines(false); }

TEST_CASE("gnomon_beside_embree_robust_is_within_its_contract_at_every_disagreement") { compare_engines(true); }
