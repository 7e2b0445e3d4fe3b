// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach and Guibas 1995).
#pragma once

#include "render/render.hpp"
#include "render/traced_scene.hpp"
#include "render/wave.hpp"

namespace render {

/// Until no path is left. Adds to the wave's pixels and ray count. Throws harness::SceneError.
///
/// Point lamps and directional ones are not seen through glass or in mirrors: no path that a camera starts can find them.
void trace_paths(const TracedScene& traced, const RenderOptions& options, Wave& wave);

}  // namespace render
