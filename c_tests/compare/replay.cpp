#include "compare/replay.hpp"

#include <cstdio>

#include "compare/classify.hpp"
#include "compare/describe.hpp"
#include "compare/engines.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

/// Prints one engine's closest hit and occlusion with the verdicts; true where neither is a fault.
bool replay_engine(Engine& engine, const GnomonRay& ray, const Oracle& oracle) {
    GnomonHit hit;
    std::uint8_t occluded = 0;
    engine.backend->prepare({&ray, 1});
    engine.backend->intersect(CallForm::fresh, {&hit, 1}, 1);
    engine.backend->occluded(CallForm::fresh, {&occluded, 1}, 1);

    const Contract contract = contract_of(engine.report);
    const Verdict closest = oracle.judge(ray, hit, contract);
    const Verdict any = oracle.judge_occluded(ray, occluded != 0, contract);
    std::printf("  %s\n    closest  %s: %s", engine.label().c_str(), hit_text(hit).c_str(), verdict_text(closest).c_str());
    if (closest.t_ulps >= 0) std::printf(" (t off by %.3g ulp, u and v by %.3g x 2^-24)", closest.t_ulps, closest.uv_error);
    std::printf("\n    any      %s: %s\n", occluded ? "occluded" : "not occluded", verdict_text(any).c_str());
    return !is_fault(engine.report, closest) && !is_fault(engine.report, any);
}

}  // namespace

bool replay_ray(const std::string& scene_spec, const Options& options, Notes& notes) {
    const Scene scene = load_scene(scene_spec);
    Progress progress(build_plans(options).size() * options.build_repeats, scene.name);
    std::vector<Engine> engines = build_engines(scene, options, progress, notes.warnings);
    if (engines.empty()) throw SceneError(scene_spec + ": no engine could be built");
    const Oracle oracle(scene);
    const GnomonRay& ray = *options.replay;
    std::printf("%s, ray %s\n  exact\n    %s\n", scene.name.c_str(), ray_text(ray).c_str(), truth_text(oracle, ray).c_str());
    bool kept = true;
    for (Engine& engine : engines) kept &= replay_engine(engine, ray, oracle);
    return kept;
}

}  // namespace harness
