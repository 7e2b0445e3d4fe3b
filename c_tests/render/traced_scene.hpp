// What all workers read: the scene, what answers rays for it, and its lamps.
#pragma once

#include "api/handles.hpp"
#include "render/lamps.hpp"
#include "render/render_scene.hpp"

namespace render {

struct TracedScene {
    /// Throws harness::SceneError. The scene must outlive it.
    TracedScene(const RenderScene& scene, std::uint32_t precision, unsigned thread_count);

    const RenderScene& scene;
    harness::SceneHandle handle;
    Lamps lamps;
};

/// Throws harness::SceneError with gnomon_last_error() where a call failed.
void require(GnomonStatus status);

}  // namespace render
