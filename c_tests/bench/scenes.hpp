// Which scenes a run measures.
#pragma once

#include <string>
#include <vector>

#include "bench/options.hpp"

namespace harness {

struct SceneChoice {
    std::string spec;
    std::size_t least_triangles;  // a smaller scene is left out
};

/// Those of the command line; else the shared scenes of 50,000 triangles or more and generated ones, with a line in `notes` where
/// the shared ones are missing.
std::vector<SceneChoice> choose_scenes(const BenchOptions& options, std::vector<std::string>& notes);

/// Those of the command line; else one each of what suits some structures and not others: an evenly spread soup, a teapot in a
/// stadium, rooms, a scan, hair, and slivers. Generated where the shared ones are missing.
std::vector<SceneChoice> choose_structure_scenes(const BenchOptions& options);

}  // namespace harness
