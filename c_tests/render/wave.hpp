// Paths that advance together, one bounce at a time, so that their rays make batches.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "gnomon.h"
#include "harness/rng.hpp"
#include "render/lamp_rays.hpp"
#include "render/render_scene.hpp"

namespace render {

struct Path {
    std::uint32_t pixel;  // of the wave's
    harness::Rng rng;
    Rgb weight{1, 1, 1};                                              // of the light that comes along the ray
    Vec3f from{};                                                     // where the ray left the last surface
    double density_per_sr = std::numeric_limits<double>::infinity();  // see Scatter
};

struct Wave {
    std::vector<Path> paths;
    std::vector<GnomonRay> rays;  // one a path
    std::vector<Rgb> pixels;      // what has arrived so far, basic radiance in nt
    std::uint64_t ray_count = 0;

    // Rooms of the tracers.
    std::vector<GnomonHit> hits;
    std::vector<Path> next_paths;
    std::vector<GnomonRay> next_rays;
    LampRays lamp_rays;

    void go_on(const Path& path, const GnomonRay& ray) {
        next_paths.push_back(path);
        next_rays.push_back(ray);
    }
    void turn() {
        paths.swap(next_paths), rays.swap(next_rays);
        next_paths.clear(), next_rays.clear();
    }
};

}  // namespace render
