// A picture of a scene: Whitted's ray tracing, or path tracing.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "gnomon.h"
#include "render/image.hpp"
#include "render/render_scene.hpp"

namespace render {

enum class Method {
    path,     // all light: next-event estimation and multiple importance sampling (Veach and Guibas 1995)
    whitted,  // direct light, mirrors and glass (Whitted 1980); light that came from a diffuse surface is left out, and so is the
              // environment there
};

/// How the path tracer finds lamps that are triangles; other lamps have no size and can only be sampled. All have the same mean.
enum class Strategy {
    multiple_importance,  // both, weighted by the power heuristic
    lamps,                // a point of a lamp
    material,             // a direction that the material prefers
};

struct RenderOptions {
    int width, height;
    int sample_count = 64;  // a pixel; one alone goes through its centre
    int max_depth = 0;      // bounces: 1 is direct light; 0: as many as Russian roulette leaves, in Whitted's method 32
    Method method = Method::path;
    unsigned thread_count = 0;  // 0: all; the picture does not depend on it
    std::uint64_t seed = 0;
    Strategy strategy = Strategy::multiple_importance;
    std::uint32_t precision = GNOMON_PRECISION_ACCURATE;
};

struct Rendering {
    Image image;
    std::uint64_t ray_count = 0;  // of all kinds
    double seconds = 0;           // without the build
    double build_seconds = 0;
    double samples_per_pixel = 0;  // that were taken, a mean where the rendering was stopped
    bool is_complete = true;
};

/// Told how many samples have been taken since the last call, `width * height * sample_count` in all. From any thread.
using RenderProgress = std::function<void(std::uint64_t)>;

/// Setting `stop` ends it early with a whole picture of fewer samples, of one a pixel at least. Throws harness::SceneError for
/// options that make no sense and where the scene cannot be built, of memory for example.
Rendering render(const RenderScene& scene, const Camera& camera, const RenderOptions& options, const RenderProgress& progress,
                 const std::atomic<bool>& stop);

}  // namespace render
