// One scene through everything: builds, rays, speed.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"
#include "scene/scene.hpp"

namespace harness {

/// Throws SceneError where the scene cannot be seen, BuildError where gnomon's default cannot be built.
SceneBench bench_scene(const Scene& scene, const BenchOptions& options, std::vector<std::string>& notes);

}  // namespace harness
