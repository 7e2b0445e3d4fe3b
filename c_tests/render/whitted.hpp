// Ray tracing as of Whitted 1980, "An improved illumination model for shaded display".
#pragma once

#include "render/render.hpp"
#include "render/traced_scene.hpp"
#include "render/wave.hpp"

namespace render {

/// Until no path is left. Adds to the wave's pixels and ray count. Throws harness::SceneError.
///
/// At a diffuse surface a ray to each lamp without a size, and one to a point of some triangle that emits; at glass both ways.
void trace_whitted(const TracedScene& traced, const RenderOptions& options, Wave& wave);

}  // namespace render
