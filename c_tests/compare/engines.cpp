#include "compare/engines.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "backend/names.hpp"
#include "compare/results.hpp"

namespace harness {
namespace {

std::unique_ptr<Backend> make_gnomon_plan(const Scene& scene, const BuildPlan& plan, const Options& options) {
    GnomonBuildOptions build;
    gnomon_build_options_init(&build);
    build.structure = plan.structure;
    build.precision = plan.precision;
    build.quality = plan.quality;
    build.isa = options.isa;
    build.compact = options.compact ? 1 : 0;
    build.thread_count = options.threads;
    build.invalid_triangles = GNOMON_INVALID_SKIP;  // as Embree does
    return make_gnomon(scene, build);
}

std::unique_ptr<Backend> make_embree_plan(const Scene& scene, const BuildPlan& plan, const Options& options) {
    return make_embree(scene, plan.robust, plan.quality, options.threads);
}

/// Takes out gnomon's structures that are not wanted for so many triangles.
void drop_unwanted(std::vector<BuildPlan>& plans, const Scene& scene, const Options& options,
                   std::vector<std::string>& warnings) {
    for (const auto& [unwanted, limit] : options.most_triangles) {
        if (scene.triangle_count() <= limit) continue;
        const auto dropped = std::erase_if(
            plans, [&](const BuildPlan& plan) { return plan.make == make_gnomon_plan && plan.structure == unwanted; });
        if (dropped == 0) continue;
        warnings.push_back(scene.name + ": without " + name_of(structure_names, unwanted) + ": more than " +
                           std::to_string(limit) + " triangles");
    }
}

auto identity(const BuildReport& report) { return std::tie(report.engine, report.structure, report.quality, report.precision); }

bool holds_same(const std::vector<Engine>& engines, const BuildReport& report) {
    return std::any_of(engines.begin(), engines.end(),
                       [&](const Engine& engine) { return identity(engine.report) == identity(report); });
}

}  // namespace

std::vector<BuildPlan> build_plans(const Options& options) {
    std::vector<BuildPlan> plans;
    for (const std::uint32_t quality : options.qualities) {
        if (!embree_version().empty()) {
            plans.push_back({"embree", make_embree_plan, 0, 0, quality, false});
            plans.push_back({"embree_robust", make_embree_plan, 0, 0, quality, true});
        }
        for (const std::uint32_t structure : options.structures) {
            for (const std::uint32_t precision : options.precisions) {
                const std::string label =
                    "gnomon " + name_of(structure_names, structure) + " " + name_of(precision_names, precision);
                plans.push_back({label, make_gnomon_plan, structure, precision, quality, false});
            }
        }
    }
    return plans;
}

std::string Engine::label() const {
    std::string text = report.engine;
    if (is_gnomon()) text += " " + report.structure + (report.compact ? " compact " : " ") + report.precision;
    return text + " " + report.quality;
}

std::vector<Engine> build_engines(const Scene& scene, const Options& options, Progress& progress,
                                  std::vector<std::string>& warnings) {
    std::vector<BuildPlan> plans = build_plans(options);
    drop_unwanted(plans, scene, options, warnings);
    std::vector<std::unique_ptr<Backend>> backends(plans.size());
    std::vector<std::vector<double>> seconds(plans.size());
    for (std::size_t round = 0; round < options.build_repeats; ++round) {
        for (std::size_t i = 0; i < plans.size(); ++i) {
            const bool failed = round > 0 && !backends[i];
            if (!failed) {
                progress.set_label(scene.name + ": builds " + plans[i].label);
                try {
                    backends[i].reset();
                    backends[i] = plans[i].make(scene, plans[i], options);
                    seconds[i].push_back(backends[i]->report().seconds);
                } catch (const BuildError& error) {
                    warnings.push_back(scene.name + ": without " + plans[i].label + ": " + error.what());
                }
            }
            progress.advance();
        }
    }

    std::vector<Engine> engines;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (!backends[i]) continue;
        BuildReport report = backends[i]->report();
        report.seconds = quantile(seconds[i], 0.5);
        if (holds_same(engines, report)) {
            warnings.push_back(scene.name + ": " + plans[i].label + " is " + report.structure + ", which is there already");
            continue;
        }
        engines.push_back({std::move(backends[i]), report});
    }
    return engines;
}

}  // namespace harness
