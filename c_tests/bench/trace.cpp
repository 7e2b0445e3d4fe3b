#include "bench/trace.hpp"

#include "bench/statistics.hpp"

namespace harness {
namespace {

/// Hit or miss, occluded or not, one a ray.
using Decisions = std::vector<std::uint8_t>;

/// Room for the answers of every run, overwritten by each.
class Answers {
public:
    explicit Answers(const RaySet& set)
        : occlusion_(set.occlusion), hits_(set.occlusion ? 0 : set.rays.size()), occluded_(set.occlusion ? set.rays.size() : 0) {}

    double trace(Backend& backend, const Run& run) {
        return occlusion_ ? backend.occluded(run.call, occluded_, run.threads) : backend.intersect(run.call, hits_, run.threads);
    }

    Decisions decisions() const {
        if (occlusion_) return occluded_;
        Decisions decisions;
        for (const GnomonHit& hit : hits_) decisions.push_back(hit.geometry_id != GNOMON_INVALID_ID);
        return decisions;
    }

private:
    bool occlusion_;
    std::vector<GnomonHit> hits_;
    std::vector<std::uint8_t> occluded_;
};

std::size_t count_differing(const Decisions& a, const Decisions& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
    return count;
}

/// Appends runs whose contender is there; a reference is named as contender, form and threads.
class RunList {
public:
    RunList(const std::vector<Contender>& contenders) : contenders_(contenders) {}

    void add(const std::string& name, CallForm call, std::uint32_t threads = 1, const std::string& reference = "",
             CallForm reference_call = CallForm::fresh) {
        const auto contender = find_contender(contenders_, name);
        if (contender) {
            const bool judges = runs_.empty() && name == "embree";
            runs_.push_back({*contender, call, threads, find(reference, reference_call), judges});
        }
    }
    std::vector<Run> take() { return std::move(runs_); }

private:
    std::optional<std::size_t> find(const std::string& name, CallForm call) const {
        for (std::size_t i = 0; i < runs_.size(); ++i) {
            const Run& run = runs_[i];
            if (contenders_[run.contender].plan.name == name && run.call == call && run.threads == 1) return i;
        }
        return {};
    }

    const std::vector<Contender>& contenders_;
    std::vector<Run> runs_;
};

void add_fresh(RunList& list, const std::vector<Contender>& contenders) {
    list.add("embree", CallForm::fresh);
    for (const Contender& contender : contenders) {
        const std::string& name = contender.plan.name;
        if (name == "embree" || !contender.plan.traced) continue;
        list.add(name, CallForm::fresh, 1, name == "gnomon high" ? "embree high" : "embree");
    }
}

std::string reference_name(const std::vector<Contender>& contenders, const Run& run, bool occlusion) {
    const Contender& contender = contenders[run.contender];
    return contender.plan.name + " " + form_name(run.call) + " " + contender.backend->call_name(run.call, occlusion);
}

}  // namespace

std::string form_name(CallForm form) {
    return form == CallForm::fresh ? "fresh" : form == CallForm::prefilled ? "prefilled" : "batch";
}

std::vector<Run> fresh_runs(const std::vector<Contender>& contenders) {
    RunList list(contenders);
    add_fresh(list, contenders);
    return list.take();
}

std::vector<Run> single_runs(const std::vector<Contender>& contenders) {
    RunList list(contenders);
    add_fresh(list, contenders);
    list.add("embree", CallForm::prefilled);
    list.add("gnomon", CallForm::prefilled, 1, "embree", CallForm::prefilled);
    list.add("gnomon fast", CallForm::prefilled, 1, "embree", CallForm::prefilled);
    return list.take();
}

std::vector<Run> batch_runs(const std::vector<Contender>& contenders, const RaySet& set, std::uint32_t threads) {
    RunList list(contenders);
    // Camera rays are what packets are for; for the others Embree's single calls over laid out rays are hard to beat.
    const CallForm embree_call = set.kind == "primary" ? CallForm::batch : CallForm::prefilled;
    list.add("embree", embree_call);
    list.add("gnomon", CallForm::batch, 1, "embree", embree_call);
    if (threads > 1) list.add("gnomon", CallForm::batch, threads, "gnomon", CallForm::batch);
    return list.take();
}

std::vector<Timing> trace_interleaved(std::vector<Contender>& contenders, const std::vector<Run>& runs, const RaySet& set,
                                      std::size_t ray_set, std::uint32_t repeats, Progress& progress) {
    for (Contender& contender : contenders) {
        if (contender.backend) contender.backend->prepare(set.rays);
    }
    Answers answers(set);
    std::vector<std::vector<double>> seconds(runs.size());
    std::vector<std::optional<std::size_t>> differing(runs.size());
    Decisions judge_decisions;
    for (std::size_t pass = 0; pass < pass_count(repeats); ++pass) {
        const bool warm_up = pass == 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const Contender& contender = contenders[runs[i].contender];
            const double taken = answers.trace(*contender.backend, runs[i]);
            if (!warm_up) {
                seconds[i].push_back(taken);
            } else if (runs[i].judges) {
                judge_decisions = answers.decisions();
            } else if (!judge_decisions.empty()) {
                differing[i] = count_differing(answers.decisions(), judge_decisions);
            }
        }
        progress.advance();
    }

    std::vector<Timing> timings;
    const double to_ns = 1e9 / static_cast<double>(set.rays.size());
    for (std::size_t i = 0; i < runs.size(); ++i) {
        Timing timing{ray_set,
                      runs[i].contender,
                      runs[i].call,
                      runs[i].threads,
                      set.rays.size(),
                      median(seconds[i]) * to_ns,
                      least(seconds[i]) * to_ns,
                      {},
                      "",
                      differing[i]};
        if (const auto reference = runs[i].reference) {
            timing.ratio = median_ratio(seconds[*reference], seconds[i]);
            timing.reference = reference_name(contenders, runs[*reference], set.occlusion);
        }
        timings.push_back(std::move(timing));
    }
    return timings;
}

}  // namespace harness
