// The interval of a ray is closed, and an answer is exactly as far away as it says.
#include <cmath>
#include <limits>

#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

using Retrace = void (*)(GnomonRay& ray, float t);
/// Whether the answer to a re-trace is as it has to be after `first`.
using Fits = bool (*)(const GnomonHit& answer, const GnomonHit& first);

bool is_same_triangle(const GnomonHit& a, const GnomonHit& b) {
    return a.geometry_id == b.geometry_id && a.primitive_id == b.primitive_id;
}

bool is_same(const GnomonHit& answer, const GnomonHit& first) { return is_same_triangle(answer, first) && answer.t == first.t; }

struct RetraceKind {
    const char* name;
    Retrace change;
    Fits fits;
};

void retrace(CaseRun& run, const Trial& trial, const std::vector<RetraceKind>& kinds) {
    run.each_engine(trial.scene, [&](const HardEngine&, Backend& backend, CaseRow& row) {
        const std::vector<GnomonHit> first = answers_of(backend, trial.rays).hits;
        for (const RetraceKind& kind : kinds) {
            std::vector<GnomonRay> rays;
            std::vector<GnomonHit> expected;
            for (std::size_t i = 0; i < first.size(); ++i) {
                if (!is_hit(first[i])) continue;
                GnomonRay ray = trial.rays[i];
                kind.change(ray, first[i].t);
                if (!(ray.t_min >= 0)) continue;  // t = 0 has no float before it that Embree takes
                rays.push_back(ray);
                expected.push_back(first[i]);
            }
            const Answers answers = answers_of(backend, rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ++row.checked;
                row.disagreements += !answers.agree(i);
                if (!kind.fits(answers.hits[i], expected[i]) || !answers.agree(i))
                    run.fail(row, trial.scene, rays[i],
                             std::string(kind.name) + ": " + hit_text(answers.hits[i]) + ", after " + hit_text(expected[i]));
            }
        }
    });
}

std::vector<Trial> trials(CaseRun& run) {
    const std::size_t count = run.ray_count(3);
    return {soup_trial(0.1, count, run.rng), needle_trial(1e-3, count, run.rng), far_mesh_trial(1e3, count, run.rng)};
}

/// What ends or begins at a hit holds it.
void run_closed_ends(CaseRun& run) {
    const std::vector<RetraceKind> kinds = {
        {"t_max = t", [](GnomonRay& ray, float t) { ray.t_max = t; }, is_same},
        {"t_min = t", [](GnomonRay& ray, float t) { ray.t_min = t; }, is_same},
        {"[t, t]", [](GnomonRay& ray, float t) { ray.t_min = ray.t_max = t; }, is_same},
    };
    for (const Trial& trial : trials(run)) retrace(run, trial, kinds);
}

/// What ends one float before the closest hit is empty; what begins one float after it does not hold the same triangle.
void run_open_ends(CaseRun& run) {
    const std::vector<RetraceKind> kinds = {
        {"t_max = prev(t)", [](GnomonRay& ray, float t) { ray.t_max = std::nextafter(t, -infinity); },
         [](const GnomonHit& answer, const GnomonHit&) { return !is_hit(answer); }},
        {"t_min = next(t)", [](GnomonRay& ray, float t) { ray.t_min = std::nextafter(t, infinity); },
         [](const GnomonHit& answer, const GnomonHit& first) { return !is_same_triangle(answer, first) && answer.t > first.t; }},
    };
    for (const Trial& trial : trials(run)) retrace(run, trial, kinds);
}

}  // namespace

std::vector<HardCase> interval_cases() {
    return {
        {18, "re-traces with t_max = t, t_min = t, [t, t]", "the same hit", run_closed_ends},
        {19, "re-traces with t_max = prev(t), t_min = next(t)", "not the same hit", run_open_ends},
    };
}

}  // namespace harness
