#include "hard/case_run.hpp"

#include <algorithm>

#include "compare/classify.hpp"
#include "compare/describe.hpp"
#include "hard/truth.hpp"

namespace harness {
namespace {

/// Of more triangles a BSP tree takes too long to build, and brute force to ask.
constexpr std::size_t most_for_bsp_tree = 30'000, most_for_brute_force = 200'000;

bool can_take(const HardEngine& engine, const Scene& scene) {
    if (!engine.is_gnomon()) return embree_takes(scene);
    if (engine.structure == "bsp_tree") return scene.triangle_count() <= most_for_bsp_tree;
    if (engine.structure == "brute_force") return scene.triangle_count() <= most_for_brute_force;
    return true;
}

bool can_take(const HardEngine& engine, const GnomonRay& ray) { return engine.is_gnomon() || embree_takes(ray); }

bool is_wrong(const Verdict& verdict) { return verdict.missed || verdict.false_hit || verdict.wrong_primitive; }

}  // namespace

CaseRun::CaseRun(const HardCase& hard_case, const HardOptions& options, const std::vector<HardEngine>& engines,
                 Failures& failures)
    : rng(rng_of(options, hard_case.name)), case_(hard_case), options_(options), engines_(engines), failures_(failures) {
    for (const HardEngine& engine : engines) {
        CaseRow& row = rows_.emplace_back();
        row.number = case_.number;
        row.name = case_.name;
        row.engine = engine;
        row.unit = case_.unit;
        row.bar = case_.bar;
    }
}

std::size_t CaseRun::ray_count(std::size_t parts) const { return std::max<std::size_t>(1, options_.ray_count / parts); }

void CaseRun::each_engine(const Scene& scene, const Check& check, const Choice& is_chosen) {
    for (std::size_t i = 0; i < engines_.size(); ++i) {
        if (!is_chosen(engines_[i]) || !can_take(engines_[i], scene)) continue;
        const std::unique_ptr<Backend> backend = make_backend(engines_[i], scene);
        check(engines_[i], *backend, rows_[i]);
    }
}

void CaseRun::judge(const Scene& scene, const std::vector<GnomonRay>& rays) {
    Truth truth(scene, rays);
    Reference reference;
    each_engine(scene, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
        const Answers answers = answers_of(backend, rays);
        const std::vector<Verdict> verdicts = truth.judge(answers.hits, contract_of(backend.report()));
        row.differences += reference.count_differences(engine, answers.hits);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!can_take(engine, rays[i])) continue;
            ++row.checked;
            row.disagreements += !answers.agree(i);
            // EXACT may not be wrong at all, nor take the second of two hits whose t round alike.
            const bool is_inexact = engine.precision == "exact" && (is_wrong(verdicts[i]) || truth.is_beaten(i, answers.hits[i]));
            const bool is_broken = is_held(engine) && (is_fault(backend.report(), verdicts[i]) || is_inexact);
            if (is_broken || !answers.agree(i)) {
                fail(row, scene, rays[i], truth.describe(i, answers.hits[i], verdicts[i]));
            } else {
                row.failed += is_wrong(verdicts[i]);
            }
        }
    });
}

void CaseRun::expect(const Scene& scene, const std::vector<GnomonRay>& rays, bool hit) {
    each_engine(scene, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
        const Answers answers = answers_of(backend, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!can_take(engine, rays[i])) continue;
            ++row.checked;
            row.disagreements += !answers.agree(i);
            if (is_hit(answers.hits[i]) != hit || (answers.occluded[i] != 0) != hit)
                fail(row, scene, rays[i], std::string(hit ? "misses" : "hits") + ": " + hit_text(answers.hits[i]));
        }
    });
}

void CaseRun::fail(CaseRow& row, const Scene& scene, const GnomonRay& ray, const std::string& what) {
    ++row.failed;
    if (!row.engine.is_gnomon()) return;
    ++row.broken;
    failures_.add(where(), row.engine, scene, ray, what);
}

std::vector<CaseRow> CaseRun::take_rows() {
    for (CaseRow& row : rows_) {
        if (!row.engine.is_gnomon()) continue;
        row.limit = case_.limit;
        if (row.failed > row.broken && row.limit.empty())
            row.limit =
                std::to_string(row.failed - row.broken) + " decided in float, within the rounding that the contract allows";
    }
    std::erase_if(rows_, [](const CaseRow& row) { return row.checked == 0; });
    return std::move(rows_);
}

}  // namespace harness
