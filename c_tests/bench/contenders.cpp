#include "bench/contenders.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "backend/names.hpp"
#include "bench/statistics.hpp"

namespace harness {
namespace {

Plan gnomon_quality(const std::string& name, std::uint32_t quality, const BenchOptions& options) {
    Plan plan = gnomon_plan(name, options);
    plan.build.quality = quality;
    plan.timed = true;
    plan.traced = quality != GNOMON_QUALITY_LOW;
    return plan;
}

Plan embree_plan(const std::string& name, std::uint32_t quality, bool robust, const BenchOptions& options) {
    Plan plan = gnomon_plan(name, options);
    plan.is_gnomon = false;
    plan.build.quality = quality;
    plan.robust = robust;
    plan.timed = !robust;
    return plan;
}

/// The instruction set that a cap comes to, by what a scene of one triangle says of itself.
std::string isa_under(std::uint32_t cap, const BenchOptions& options) {
    Plan plan = gnomon_plan("", options);
    plan.build.isa = cap;
    plan.build.structure = GNOMON_STRUCTURE_WIDE_BVH;
    return build_plan(Scene{"one triangle", {{"", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}}}, plan)->report().isa;
}

std::vector<Plan> isa_plans(const BenchOptions& options) {
    std::vector<Plan> plans;
    std::set<std::string> known = {isa_under(GNOMON_ISA_AUTO, options)};
    for (const std::uint32_t cap : {GNOMON_ISA_SCALAR, GNOMON_ISA_SSE42, GNOMON_ISA_AVX2, GNOMON_ISA_AVX512}) {
        const std::string isa = isa_under(cap, options);
        if (!known.insert(isa).second) continue;
        plans.push_back(gnomon_plan("gnomon " + isa, options));
        plans.back().build.isa = cap;
    }
    return plans;
}

/// Embree's plan of the like quality; gnomon's LOW is set against the least that is measured of Embree.
std::string build_reference(const Plan& plan) { return plan.build.quality == GNOMON_QUALITY_HIGH ? "embree high" : "embree"; }

using Seconds = std::map<std::string, std::vector<double>>;

void summarize(Contender& contender, const Seconds& seconds) {
    BuildTiming& timing = contender.timing;
    timing.contender = contender.plan.name;
    timing.least_seconds = timing.report.seconds;
    const auto own = seconds.find(contender.plan.name);
    if (own == seconds.end()) return;
    timing.report.seconds = median(own->second);
    timing.least_seconds = least(own->second);
    timing.repeats = own->second.size();
    const auto reference = seconds.find(build_reference(contender.plan));
    if (!contender.plan.is_gnomon || reference == seconds.end()) return;
    timing.time_ratio = median_ratio(own->second, reference->second);
    timing.reference = reference->first;
}

}  // namespace

Plan gnomon_plan(const std::string& name, const BenchOptions& options) {
    Plan plan;
    plan.name = name;
    gnomon_build_options_init(&plan.build);
    plan.build.precision = GNOMON_PRECISION_ACCURATE;
    plan.build.thread_count = options.threads;
    plan.build.invalid_triangles = GNOMON_INVALID_SKIP;  // as Embree does
    return plan;
}

std::vector<Plan> bench_plans(const BenchOptions& options) {
    const bool with_embree = !embree_version().empty();
    std::vector<Plan> plans;
    const auto add_embree = [&](const std::string& name, std::uint32_t quality, bool robust) {
        if (with_embree) plans.push_back(embree_plan(name, quality, robust, options));
    };
    add_embree("embree", GNOMON_QUALITY_MEDIUM, false);
    plans.push_back(gnomon_quality("gnomon", GNOMON_QUALITY_MEDIUM, options));
    plans.push_back(gnomon_quality("gnomon low", GNOMON_QUALITY_LOW, options));
    add_embree("embree high", GNOMON_QUALITY_HIGH, false);
    plans.push_back(gnomon_quality("gnomon high", GNOMON_QUALITY_HIGH, options));
    add_embree("embree robust", GNOMON_QUALITY_MEDIUM, true);
    plans.push_back(gnomon_plan("gnomon fast", options));
    plans.back().build.precision = GNOMON_PRECISION_FAST;
    plans.push_back(gnomon_plan("gnomon compact", options));
    plans.back().build.compact = 1;
    plans.back().traced = false;
    for (Plan& plan : isa_plans(options)) plans.push_back(std::move(plan));
    return plans;
}

std::unique_ptr<Backend> build_plan(const Scene& scene, const Plan& plan) {
    return plan.is_gnomon ? make_gnomon(scene, plan.build)
                          : make_embree(scene, plan.robust, plan.build.quality, plan.build.thread_count);
}

std::optional<std::size_t> find_contender(const std::vector<Contender>& contenders, const std::string& name) {
    const auto found = std::find_if(contenders.begin(), contenders.end(),
                                    [&](const Contender& contender) { return contender.plan.name == name; });
    if (found == contenders.end()) return {};
    return static_cast<std::size_t>(found - contenders.begin());
}

std::size_t build_step_count(const std::vector<Plan>& plans, const BenchOptions& options) {
    std::size_t count = 0;
    for (const Plan& plan : plans) count += plan.timed ? 1 + options.build_repeats : 1;
    return count;
}

std::vector<Contender> build_contenders(const Scene& scene, const std::vector<Plan>& plans, const BenchOptions& options,
                                        Progress& progress, std::vector<std::string>& not_built,
                                        std::vector<std::string>& notes) {
    std::vector<Contender> contenders;
    for (const Plan& plan : plans) contenders.push_back({plan, {}, nullptr});
    std::set<std::string> failed;
    Seconds seconds;
    for (std::size_t round = 0; round <= options.build_repeats; ++round) {
        const bool warm_up = round == 0;
        for (Contender& contender : contenders) {
            const Plan& plan = contender.plan;
            if (!plan.timed && !warm_up) continue;
            progress.advance();
            if (failed.contains(plan.name)) continue;
            progress.set_label(scene.name + ": builds " + plan.name);
            try {
                contender.backend.reset();
                contender.backend = build_plan(scene, plan);
                contender.timing.report = contender.backend->report();
                if (!warm_up) seconds[plan.name].push_back(contender.timing.report.seconds);
                if (!plan.traced) contender.backend.reset();
            } catch (const BuildError& error) {
                failed.insert(plan.name);
                if (error.status == GNOMON_ERROR_UNSUPPORTED) {
                    not_built.push_back(plan.name);
                } else {
                    notes.push_back(scene.name + ": without " + plan.name + ": " + error.what());
                }
            }
        }
    }
    std::erase_if(contenders, [&](const Contender& contender) { return failed.contains(contender.plan.name); });
    for (Contender& contender : contenders) summarize(contender, seconds);
    return contenders;
}

}  // namespace harness
