// One ray through every engine, beside the oracle.
#pragma once

#include <string>

#include "compare/options.hpp"
#include "compare/run.hpp"

namespace harness {

/// Prints each engine's answers to options.replay. True where gnomon keeps its contract. Throws SceneError as run_scene() does.
bool replay_ray(const std::string& scene_spec, const Options& options, Notes& notes);

}  // namespace harness
