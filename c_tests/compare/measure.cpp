#include "compare/measure.hpp"

#include <algorithm>

namespace harness {
namespace {

// Triangle tests in one pass of brute force: under ten seconds.
constexpr std::size_t brute_force_test_limit = 2'000'000'000;

struct Contender {
    std::size_t engine;
    CallForm call;
    std::vector<double> seconds;
};

std::size_t affordable_rays(const Engine& engine, std::size_t count) {
    if (engine.report.structure != "brute_force" || engine.report.triangles == 0) return count;
    return std::min(count, std::max<std::size_t>(1, brute_force_test_limit / engine.report.triangles));
}

/// Room for the answers of every engine, overwritten by each.
struct Answers {
    std::vector<GnomonHit> hits;
    std::vector<std::uint8_t> occluded;
    explicit Answers(const RaySet& set)
        : hits(set.occlusion ? 0 : set.rays.size()), occluded(set.occlusion ? set.rays.size() : 0) {}

    double trace(Backend& backend, CallForm call, bool occlusion, std::size_t count, std::uint32_t threads) {
        return occlusion ? backend.occluded(call, std::span(occluded).first(count), threads)
                         : backend.intersect(call, std::span(hits).first(count), threads);
    }
};

void set_ratios(std::vector<Speed>& speeds, std::vector<Engine>& engines, bool occlusion) {
    for (Speed& speed : speeds) {
        for (const Speed& reference : speeds) {
            const Engine& embree = engines[reference.build];
            const bool comparable = embree.report.engine == "embree" && reference.call == speed.call &&
                                    embree.report.quality == engines[speed.build].report.quality;
            if (!comparable) continue;
            speed.ratio_to_embree = reference.ns_per_ray / speed.ns_per_ray;
            speed.embree_call = embree.backend->call_name(reference.call, occlusion);
        }
    }
}

}  // namespace

std::vector<Speed> measure(std::vector<Engine>& engines, const RaySet& set, const Options& options, Progress& progress,
                           std::vector<std::string>& warnings) {
    std::vector<std::vector<GnomonRay>> parts(engines.size());
    std::vector<std::size_t> counts(engines.size());
    std::vector<Contender> contenders;
    for (std::size_t i = 0; i < engines.size(); ++i) {
        counts[i] = affordable_rays(engines[i], set.rays.size());
        if (counts[i] < set.rays.size()) {
            parts[i] = spread_rays(set.rays, counts[i]);
            warnings.push_back(set.kind + ": " + engines[i].label() + " traces " + std::to_string(counts[i]) + " rays only");
        }
        engines[i].backend->prepare(parts[i].empty() ? set.rays : parts[i]);
        for (const CallForm call : options.calls) contenders.push_back({i, call, {}});
    }

    Answers answers(set);
    for (std::size_t pass = 0; pass < passes(options); ++pass) {
        for (Contender& contender : contenders) {
            Backend& backend = *engines[contender.engine].backend;
            const double seconds =
                answers.trace(backend, contender.call, set.occlusion, counts[contender.engine], options.threads);
            const bool warm_up = pass == 0;
            if (!warm_up) contender.seconds.push_back(seconds);
            progress.advance();
        }
    }

    std::vector<Speed> speeds;
    for (const Contender& contender : contenders) {
        const std::size_t count = counts[contender.engine];
        const std::uint32_t threads = contender.call == CallForm::batch ? options.threads : 1;
        const double ns_per_ray = quantile(contender.seconds, 0.5) * 1e9 / static_cast<double>(count);
        speeds.push_back({contender.engine, contender.call, threads, count, set.kind, ns_per_ray, {}, ""});
    }
    set_ratios(speeds, engines, set.occlusion);
    return speeds;
}

}  // namespace harness
