// accuracy.md's populations: scenes and rays that are hard in one measurable way each.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "gnomon.h"
#include "harness/rng.hpp"
#include "scene/scene.hpp"

namespace harness {

/// A scene and rays that are asked of it.
struct Trial {
    Scene scene;
    std::vector<GnomonRay> rays;
};

// Each aims its rays at points of random triangles, from a few units away unless it says otherwise.

/// Triangles whose corners lie within `size` of random points of a cube of side 2.
Trial soup_trial(double size, std::size_t count, Rng& rng);

/// Slivers up to 1 long, `width` times as wide.
Trial needle_trial(double width, std::size_t count, Rng& rng);

/// Rays that meet their triangle's plane at `angle` (radians).
Trial grazing_trial(double angle, std::size_t count, Rng& rng);

/// From `distance` away.
Trial far_origin_trial(double distance, std::size_t count, Rng& rng);

/// A sphere of radius 1 around (offset, offset, offset).
Trial far_mesh_trial(double offset, std::size_t count, Rng& rng);

/// Triangles of size 1 seen from `distance` away.
Trial near_hit_trial(double distance, std::size_t count, Rng& rng);

/// At points that have the weight `inside` next to an edge; 0: on it, but for rounding.
Trial edge_trial(double inside, std::size_t count, Rng& rng);

struct Population {
    std::string name, what;
    std::function<Trial(std::size_t count, Rng& rng)> make;
};
const std::vector<Population>& populations();

}  // namespace harness
