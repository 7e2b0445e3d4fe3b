// Scenes that are hard on a builder: nothing to tell triangles apart by, or sizes that are far apart.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gnomon.h"
#include "scene/scene.hpp"

namespace harness {

struct DegenerateScene {
    std::string name;
    Scene (*make)(std::size_t triangle_count);
};
const std::vector<DegenerateScene>& degenerate_scenes();

/// Half from about the scene towards points of its box, half between two points of its box, so within the plane or along the line
/// where it has no more extent.
std::vector<GnomonRay> degenerate_rays(const Scene& scene, std::size_t count);

}  // namespace harness
