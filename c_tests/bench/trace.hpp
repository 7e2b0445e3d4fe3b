// Speed: engine after engine over the same rays, repeat by repeat.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/contenders.hpp"
#include "bench/results.hpp"
#include "rays/rays.hpp"

namespace harness {

/// One contender in one call form.
struct Run {
    std::size_t contender;
    CallForm call;
    std::uint32_t threads;                 // of a batch
    std::optional<std::size_t> reference;  // the run that it is set against
    bool judges = false;                   // the answers of the runs after it are compared with its own
};

/// "fresh", "prefilled", "batch".
std::string form_name(CallForm form);

// In each of these lists Embree is the first where it is there, and judges.

/// Fresh calls of every contender.
std::vector<Run> fresh_runs(const std::vector<Contender>& contenders);

/// The same, and prefilled ones.
std::vector<Run> single_runs(const std::vector<Contender>& contenders);

/// Batches on one thread and on `threads`, and what they are set against.
std::vector<Run> batch_runs(const std::vector<Contender>& contenders, const RaySet& set, std::uint32_t threads);

/// One Timing a run, for the ray set with the index `ray_set`; a warm-up precedes the repeats.
std::vector<Timing> trace_interleaved(std::vector<Contender>& contenders, const std::vector<Run>& runs, const RaySet& set,
                                      std::size_t ray_set, std::uint32_t repeats, Progress& progress);

/// Passes over a ray set: steps of the progress bar.
inline std::size_t pass_count(std::uint32_t repeats) { return 1 + repeats; }

}  // namespace harness
