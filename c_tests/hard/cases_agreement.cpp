// One answer from everything: structures, instruction sets, qualities, threads, forms of calls, and build options.
#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

/// The build options that change nothing but speed and memory, beside those that make an engine.
std::vector<GnomonBuildOptions> variants(const HardEngine& engine) {
    std::vector<GnomonBuildOptions> list;
    for (const std::uint32_t quality : {GNOMON_QUALITY_LOW, GNOMON_QUALITY_MEDIUM, GNOMON_QUALITY_HIGH}) {
        GnomonBuildOptions options = engine.options;
        options.quality = quality;
        options.thread_count = 1 + quality % 2;
        list.push_back(options);
    }
    if (engine.options.structure == GNOMON_STRUCTURE_GRID) {
        list.push_back(engine.options);
        list.back().grid_cells_per_triangle = 27;
    }
    return list;
}

void compare_forms(CaseRun& run, const Trial& trial, Backend& backend, const std::vector<GnomonHit>& expected, CaseRow& row) {
    const auto& [scene, rays] = trial;
    std::vector<GnomonHit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    backend.prepare(rays);
    for (const CallForm form : {CallForm::fresh, CallForm::prefilled, CallForm::batch}) {
        backend.intersect(form, hits, 2);
        backend.occluded(form, occluded, 2);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ++row.checked;
            if (is_same_hit(hits[i], expected[i]) && (occluded[i] != 0) == is_hit(expected[i])) continue;
            ++row.differences;
            run.fail(row, scene, rays[i], hit_text(hits[i]) + ", by others " + hit_text(expected[i]));
        }
    }
}

void run_agreement(CaseRun& run) {
    constexpr std::size_t part_count = 3;
    const std::size_t count = run.ray_count(part_count);
    std::vector<Trial> trials = {
        soup_trial(0.1, count / 2, run.rng), needle_trial(1e-3, count / 2, run.rng), {generate_scene("cube_grid", 768), {}}};
    for (Trial& trial : trials) {
        const std::vector<GnomonRay> aimed = aimed_rays(trial.scene, count - trial.rays.size(), run.rng);
        trial.rays.insert(trial.rays.end(), aimed.begin(), aimed.end());
        std::map<std::string, std::vector<GnomonHit>> expected;  // by precision
        const auto check = [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
            if (!expected.contains(engine.precision)) expected[engine.precision] = answers_of(backend, trial.rays).hits;
            for (const GnomonBuildOptions& options : variants(engine))
                compare_forms(run, trial, *make_gnomon(trial.scene, options), expected[engine.precision], row);
        };
        run.each_engine(trial.scene, check, [](const HardEngine& engine) { return engine.is_exacting(); });
    }
}

}  // namespace

std::vector<HardCase> agreement_cases() {
    return {
        {40, "structures x instruction sets x threads x calls x build options", "the same bits", run_agreement, "", "answers"}};
}

}  // namespace harness
