#include "compare/classify.hpp"

#include "compare/describe.hpp"
#include "harness/parallel_for.hpp"
#include "oracle/judge.hpp"

namespace harness {
namespace {

/// An engine's answers to a sample of rays, one way of asking or the other.
struct Answers {
    std::vector<GnomonHit> hits;
    std::vector<std::uint8_t> occluded;
};

Answers answers_of(Backend& backend, const std::vector<GnomonRay>& rays, bool occlusion, const Options& options) {
    Answers answers;
    backend.prepare(rays);
    if (occlusion) {
        answers.occluded.resize(rays.size());
        backend.occluded(options.calls.front(), answers.occluded, options.threads);
    } else {
        answers.hits.resize(rays.size());
        backend.intersect(options.calls.front(), answers.hits, options.threads);
    }
    return answers;
}

/// The verdicts of each engine, an entry a ray. The oracle looks at a ray once, for all engines.
std::vector<std::vector<Verdict>> judge_all(const Oracle& oracle, const std::vector<GnomonRay>& rays,
                                            const std::vector<Engine>& engines, const std::vector<Answers>& answers,
                                            Progress& progress) {
    std::vector<std::vector<Verdict>> verdicts(engines.size(), std::vector<Verdict>(rays.size()));
    parallel_for(rays.size(), [&](std::size_t i) {
        const std::vector<Candidate> found = oracle.candidates(rays[i]);
        for (std::size_t build = 0; build < engines.size(); ++build) {
            const Contract contract = contract_of(engines[build].report);
            const Answers& given = answers[build];
            verdicts[build][i] = given.hits.empty() ? judge_occluded(rays[i], given.occluded[i] != 0, found, contract)
                                                    : oracle.judge(rays[i], given.hits[i], found, contract);
        }
        if (i % rays_per_step == 0) progress.advance(engines.size());
    });
    return verdicts;
}

Quantiles quantiles(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0.99), quantile(values, 1)};
}

std::string fault_text(const Engine& engine, const RaySet& set, const GnomonRay& ray, const std::string& answer,
                       const Verdict& verdict, const Oracle& oracle, const std::string& scene_spec) {
    return scene_spec + ", " + set.kind + ", " + engine.label() + ": " + verdict_text(verdict) + "\n  ray     " + ray_text(ray) +
           "\n  gnomon  " + answer + "\n  exact   " + truth_text(oracle, ray) + "\n  replay  " +
           replay_command(engine.report, scene_spec, ray) + "\n";
}

}  // namespace

Errors count_errors(const BuildReport& report, const std::vector<Verdict>& verdicts) {
    Errors errors{};
    std::vector<double> t_ulps, uv_errors;
    for (const Verdict& verdict : verdicts) {
        errors.missed += verdict.missed;
        errors.false_hits += verdict.false_hit;
        errors.wrong_primitive += verdict.wrong_primitive;
        errors.outside_contract += is_fault(report, verdict);
        errors.ties += verdict.tie;
        if (verdict.t_ulps >= 0) t_ulps.push_back(verdict.t_ulps);
        if (verdict.uv_error >= 0) uv_errors.push_back(verdict.uv_error);
    }
    errors.t_ulps = quantiles(t_ulps);
    errors.uv = quantiles(uv_errors);
    return errors;
}

std::string replay_command(const BuildReport& report, const std::string& scene_spec, const GnomonRay& ray) {
    return "gnomon-compare '" + scene_spec + "' --structures " + report.structure + " --precisions " + report.precision +
           " --quality " + report.quality + " --isa " + report.isa + (report.compact ? " --compact" : "") +
           " --replay=" + ray_text(ray);
}

Contract contract_of(const BuildReport& report) {
    if (report.engine != "gnomon") return Contract::none;
    return report.precision == "exact" ? Contract::exact : Contract::banded;
}

bool is_fault(const BuildReport& report, const Verdict& verdict) {
    if (report.precision != "fast") return verdict.outside_contract;
    return verdict.outside_contract && (verdict.missed || verdict.invented);
}

std::vector<Errors> classify(std::vector<Engine>& engines, const RaySet& set, const Oracle& oracle, const std::string& scene_spec,
                             const Options& options, Progress& progress, std::vector<std::string>& faults) {
    const std::vector<GnomonRay> rays = spread_rays(set.rays, options.oracle_ray_count);
    std::vector<Answers> answers;
    for (const Engine& engine : engines) answers.push_back(answers_of(*engine.backend, rays, set.occlusion, options));
    const std::vector<std::vector<Verdict>> verdicts = judge_all(oracle, rays, engines, answers, progress);
    std::vector<Errors> rows;
    for (std::size_t build = 0; build < engines.size(); ++build) {
        const Engine& engine = engines[build];
        Errors errors = count_errors(engine.report, verdicts[build]);
        errors.build = build;
        errors.ray_kind = set.kind;
        errors.ray_count = rays.size();
        rows.push_back(errors);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Verdict& verdict = verdicts[build][i];
            if (!is_fault(engine.report, verdict)) continue;
            const std::string answer =
                set.occlusion ? (answers[build].occluded[i] ? "occluded" : "not occluded") : hit_text(answers[build].hits[i]);
            faults.push_back(fault_text(engine, set, rays[i], answer, verdict, oracle, scene_spec));
        }
    }
    return rows;
}

}  // namespace harness
