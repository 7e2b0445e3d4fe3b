// Everything that can be built for one scene, built side by side.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backend/backend.hpp"
#include "compare/options.hpp"
#include "harness/progress.hpp"

namespace harness {

/// One way of building a scene. `make` may throw BuildError.
struct BuildPlan {
    std::string label;
    std::unique_ptr<Backend> (*make)(const Scene&, const BuildPlan&, const Options&);
    std::uint32_t structure, precision, quality;  // gnomon's; Embree knows the quality alone
    bool robust;                                  // Embree's
};

std::vector<BuildPlan> build_plans(const Options& options);

struct Engine {
    std::unique_ptr<Backend> backend;
    BuildReport report;  // with the median of the build times

    bool is_gnomon() const { return report.engine == "gnomon"; }
    std::string label() const;
};

/// Builds each plan options.build_repeats times, interleaved. A plan that fails is left out with a line in `warnings`; so is one
/// whose structure is not wanted for so many triangles, and one that turns out the same as an earlier one, as `auto` may.
std::vector<Engine> build_engines(const Scene& scene, const Options& options, Progress& progress,
                                  std::vector<std::string>& warnings);

}  // namespace harness
