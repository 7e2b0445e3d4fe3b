// Errors: a sample of every engine's answers, judged by the exact oracle.
#pragma once

#include <string>
#include <vector>

#include "compare/engines.hpp"
#include "compare/results.hpp"
#include "oracle/oracle.hpp"
#include "rays/rays.hpp"

namespace harness {

/// Rays judged for one step of the progress bar.
constexpr std::size_t rays_per_step = 100;

/// What an engine is held to: Embree to nothing.
Contract contract_of(const BuildReport& report);

/// Whether gnomon broke its contract. FAST is held to its decisions alone: it may miss or invent a hit only within the band,
/// while its f32 t, u, v, and so which of two near surfaces comes first, are promised nothing.
bool is_fault(const BuildReport& report, const Verdict& verdict);

/// The verdicts' sums and quantiles; without the fields that say where the answers are from.
Errors count_errors(const BuildReport& report, const std::vector<Verdict>& verdicts);

/// The command that traces one ray of a scene file or generator once more.
std::string replay_command(const BuildReport& report, const std::string& scene_spec, const GnomonRay& ray);

/// One Errors an engine, in the first call form asked for. Each fault of gnomon's adds a paragraph to `faults` that ends with the
/// command that replays it.
std::vector<Errors> classify(std::vector<Engine>& engines, const RaySet& set, const Oracle& oracle, const std::string& scene_spec,
                             const Options& options, Progress& progress, std::vector<std::string>& faults);

}  // namespace harness
