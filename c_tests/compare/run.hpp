// One scene through everything: builds, rays, speed, errors, picture.
#pragma once

#include <string>
#include <vector>

#include "compare/options.hpp"
#include "compare/results.hpp"

namespace harness {

/// What a run has to say beside its figures.
struct Notes {
    std::vector<std::string> warnings;  // a line each
    std::vector<std::string> faults;    // a paragraph each: gnomon outside its contract
};

/// Throws SceneError where the scene cannot be loaded or seen, or where no engine can be built for it.
SceneResult run_scene(const std::string& scene_spec, const Options& options, Notes& notes);

}  // namespace harness
