#include "compare/run.hpp"

#include <algorithm>

#include "compare/classify.hpp"
#include "compare/engines.hpp"
#include "compare/measure.hpp"
#include "compare/picture.hpp"
#include "rays/rays.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr std::uint64_t bounce_seed = 1, shadow_seed = 2, random_seed = 3;

std::size_t step_count(const Options& options) {
    const std::size_t engine_count = build_plans(options).size();
    const std::size_t judged_steps = (options.oracle_ray_count + rays_per_step - 1) / rays_per_step;
    return engine_count *
           (options.build_repeats + options.ray_kinds.size() * (options.calls.size() * passes(options) + judged_steps));
}

/// Whose hits the other rays start from: gnomon's, as precise as there are.
Backend& reference(std::vector<Engine>& engines) {
    const auto precise = [](const Engine& engine) { return engine.is_gnomon() && engine.report.precision != "fast"; };
    const auto affordable = [&](const Engine& engine) { return precise(engine) && engine.report.structure != "brute_force"; };
    auto found = std::find_if(engines.begin(), engines.end(), affordable);
    if (found == engines.end()) found = engines.begin();
    return *found->backend;
}

std::vector<GnomonHit> trace(Backend& backend, const RaySet& set) {
    std::vector<GnomonHit> hits(set.rays.size());
    backend.prepare(set.rays);
    backend.intersect(CallForm::prefilled, hits, 1);
    return hits;
}

/// The kinds asked for, in that order; a kind for which the scene has no ray is left out with a warning.
std::vector<RaySet> make_rays(const Scene& scene, const Camera& camera, Backend& tracer, const Options& options, Notes& notes) {
    const RaySet primary = primary_rays(camera, options.ray_count);
    const std::vector<GnomonHit> hits = trace(tracer, primary);
    std::vector<RaySet> sets;
    for (const std::string& kind : options.ray_kinds) {
        RaySet set = kind == "primary"  ? primary
                     : kind == "bounce" ? bounce_rays(scene, primary, hits, options.ray_count, bounce_seed)
                     : kind == "shadow" ? shadow_rays(scene, primary, hits, options.ray_count, shadow_seed)
                                        : random_rays(scene, options.ray_count, random_seed);
        if (set.rays.empty()) {
            notes.warnings.push_back(scene.name + ": no " + kind + " rays: no primary ray hits a place to start one from");
        } else {
            sets.push_back(std::move(set));
        }
    }
    return sets;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

SceneResult run_scene(const std::string& scene_spec, const Options& options, Notes& notes) {
    const Scene scene = load_scene(scene_spec);
    const Camera camera = outside_camera(scene);
    Progress progress(step_count(options), scene.name);
    std::vector<Engine> engines = build_engines(scene, options, progress, notes.warnings);
    if (engines.empty()) throw SceneError(scene_spec + ": no engine could be built");

    SceneResult result;
    result.name = scene.name;
    result.triangle_count = scene.triangle_count();
    for (const Engine& engine : engines) result.builds.push_back(engine.report);
    Backend& tracer = reference(engines);
    if (!options.html_path.empty()) result.picture_png = render_picture(tracer, camera);

    const Oracle oracle(scene);
    for (const RaySet& set : make_rays(scene, camera, tracer, options, notes)) {
        progress.set_label(scene.name + ": traces " + set.kind + " rays");
        append(result.speeds, measure(engines, set, options, progress, notes.warnings));
        if (options.oracle_ray_count == 0) continue;
        progress.set_label(scene.name + ": judges " + set.kind + " rays");
        append(result.errors, classify(engines, set, oracle, scene_spec, options, progress, notes.faults));
    }
    return result;
}

}  // namespace harness
