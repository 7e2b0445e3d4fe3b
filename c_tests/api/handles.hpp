// Builders and scenes that free themselves.
#pragma once

#include <memory>

#include "gnomon.h"

namespace harness {

struct FreeHandle {
    void operator()(GnomonSceneBuilder* builder) const { gnomon_scene_builder_free(builder); }
    void operator()(GnomonScene* scene) const { gnomon_scene_free(scene); }
};
using BuilderHandle = std::unique_ptr<GnomonSceneBuilder, FreeHandle>;
using SceneHandle = std::unique_ptr<GnomonScene, FreeHandle>;

inline BuilderHandle new_builder() { return BuilderHandle(gnomon_scene_builder_new()); }

}  // namespace harness
