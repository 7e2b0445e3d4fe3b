// Every structure on one scene.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"
#include "scene/scene.hpp"

namespace harness {

/// Single calls on one thread, on the same rays. What was left out gets a line in `notes`. Throws BuildError without the
/// reference structure.
StructureScene bench_structures(const Scene& scene, const BenchOptions& options, std::vector<std::string>& notes);

}  // namespace harness
