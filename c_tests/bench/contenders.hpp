// The engines, qualities, precisions and instruction sets that are set side by side on a scene.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backend/backend.hpp"
#include "bench/options.hpp"
#include "bench/results.hpp"
#include "harness/progress.hpp"

namespace harness {

/// One way of building a scene. gnomon is AUTO, ACCURATE, MEDIUM on the best instruction set unless its name says otherwise:
/// "gnomon", "gnomon low", "gnomon high", "gnomon fast", "gnomon compact", "gnomon sse42", ...; "embree", "embree high",
/// "embree robust".
struct Plan {
    std::string name;
    bool is_gnomon = true;
    GnomonBuildOptions build{};  // gnomon's; Embree knows the quality and the threads alone
    bool robust = false;         // Embree's
    bool timed = false;          // built again and again; else once
    bool traced = true;
};

/// ACCURATE, MEDIUM and AUTO on options.threads, built once, and traced.
Plan gnomon_plan(const std::string& name, const BenchOptions& options);

/// Embree's plans are there only where this program was built with it. A cap on the instruction set that comes to one of the
/// other plans is left out.
std::vector<Plan> bench_plans(const BenchOptions& options);

/// Throws BuildError.
std::unique_ptr<Backend> build_plan(const Scene& scene, const Plan& plan);

struct Contender {
    Plan plan;
    BuildTiming timing;
    std::unique_ptr<Backend> backend;  // null where the plan is not traced
};

std::optional<std::size_t> find_contender(const std::vector<Contender>& contenders, const std::string& name);

/// Builds that build_contenders() makes: its steps of the progress bar.
std::size_t build_step_count(const std::vector<Plan>& plans, const BenchOptions& options);

/// Builds each plan, the timed ones interleaved after a warm-up. One that is unsupported goes to `not_built`, one that fails
/// otherwise leaves a line in `notes`.
std::vector<Contender> build_contenders(const Scene& scene, const std::vector<Plan>& plans, const BenchOptions& options,
                                        Progress& progress, std::vector<std::string>& not_built, std::vector<std::string>& notes);

}  // namespace harness
