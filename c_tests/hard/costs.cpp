#include "hard/costs.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "backend/names.hpp"
#include "compare/run.hpp"
#include "hard/answers.hpp"
#include "hard/invalid_rays.hpp"
#include "hard/populations.hpp"

namespace harness {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

Options timing_options(const HardOptions& options) {
    Options timing;
    timing.structures = {GNOMON_STRUCTURE_WIDE_BVH};
    for (const NamedValue& named : precision_names)
        if (std::ranges::count(options.precisions, named.name) != 0) timing.precisions.push_back(named.value);
    timing.qualities = {GNOMON_QUALITY_MEDIUM};
    timing.ray_kinds = {"primary", "bounce", "shadow", "random"};
    timing.calls = {CallForm::fresh};
    timing.ray_count = options.is_full() ? 100'000 : 5'000;
    timing.repeats = options.is_full() ? 7 : 3;
    timing.oracle_ray_count = 0;
    return timing;
}

/// Large ones take most of the time to build, and show no other cost.
std::vector<std::string> timed_scenes(const HardOptions& options) {
    if (!options.is_full()) return {"gen:soup:20000"};
    std::vector<std::string> specs = {"gen:soup", "gen:terrain", "gen:interior", "gen:hair"};
    const std::filesystem::path folder = GNOMON_SHARED_SCENES;
    constexpr std::uintmax_t largest = 8'000'000;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".glb" && entry.file_size() <= largest) specs.push_back(entry.path().string());
    std::ranges::sort(specs);
    return specs;
}

double ns_of(const SceneResult& scene, const std::string& ray_kind, const std::string& precision) {
    for (const Speed& speed : scene.speeds)
        if (speed.ray_kind == ray_kind && scene.builds[speed.build].precision == precision) return speed.ns_per_ray;
    return nan_value;
}

}  // namespace

std::vector<PrecisionCost> measure_precision_costs(const HardOptions& options, std::vector<std::string>& notes) {
    const Options timing = timing_options(options);
    std::vector<PrecisionCost> costs;
    for (const std::string& spec : timed_scenes(options)) {
        Notes scene_notes;
        const SceneResult scene = run_scene(spec, timing, scene_notes);
        notes.insert(notes.end(), scene_notes.warnings.begin(), scene_notes.warnings.end());
        for (const std::string& kind : timing.ray_kinds)
            costs.push_back(
                {scene.name, kind, ns_of(scene, kind, "fast"), ns_of(scene, kind, "accurate"), ns_of(scene, kind, "exact")});
    }
    return costs;
}

InvalidCost measure_invalid_cost(const HardOptions& options) {
    constexpr std::size_t ray_count = 20'000, repeats = 7;
    Rng rng = rng_of(options, "invalid cost");
    const Trial trial = soup_trial(0.1, ray_count, rng);
    GnomonBuildOptions build;
    gnomon_build_options_init(&build);
    build.structure = GNOMON_STRUCTURE_WIDE_BVH;
    const auto backend = make_gnomon(trial.scene, build);

    // Ordinary misses: the rays end before what they would hit.
    std::vector<std::vector<GnomonRay>> sets = {trial.rays};
    const std::vector<GnomonHit> hits = answers_of(*backend, trial.rays).hits;
    for (std::size_t i = 0; i < ray_count; ++i) sets[0][i].t_max = is_hit(hits[i]) ? 0.5f * hits[i].t : 1.0f;
    for (const InvalidRay& invalid : invalid_rays()) {
        std::vector<GnomonRay>& set = sets.emplace_back(trial.rays);
        std::ranges::transform(set, set.begin(), invalid.spoil);
    }
    std::vector<std::vector<double>> seconds(sets.size());
    std::vector<GnomonHit> answers(ray_count);
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
        for (std::size_t i = 0; i < sets.size(); ++i) {
            backend->prepare(sets[i]);
            seconds[i].push_back(backend->intersect(CallForm::prefilled, answers, 1));
        }
    }
    const auto ns = [&](const std::vector<double>& times) { return quantile(times, 0.5) * 1e9 / double(ray_count); };
    InvalidCost cost{ns(seconds[0]), 0};
    for (std::size_t i = 1; i < sets.size(); ++i) cost.invalid_ns = std::max(cost.invalid_ns, ns(seconds[i]));
    return cost;
}

}  // namespace harness
