#include "render/render_scene.hpp"

#include <algorithm>

namespace render {

namespace {

bool is_lit(const Rgb& light) {
    return std::ranges::any_of(light, [](float channel) { return channel > 0; });
}

}  // namespace

bool RenderScene::has_light() const {
    const auto emits = [&](const Surface& surface) {
        return surface.mesh.triangle_count() > 0 && is_lit(materials[surface.material_id].emission_nt);
    };
    return !point_lights.empty() || !spot_lights.empty() || !directional_lights.empty() || is_lit(environment_nt) ||
           std::ranges::any_of(surfaces, emits);
}

}  // namespace render
