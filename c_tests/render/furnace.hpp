// What each method makes of each kind of surface, in numbers.
#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>

#include "render/render.hpp"

namespace render {

/// Renders with every method, one path through the centre of each pixel, and takes the means of the pixels by what that ray hits
/// first: diffuse, mirror, glass, background, and all. Of gen:furnace each is 1 nt where no light is lost or made.
///
/// {"methods": [{"method": "path", "classes": [{"class": "diffuse", "mean", "standard_error", "sample_count", "pixel_count"}]}]},
/// in nt; a class that no pixel has is left out. `progress` as render() has it, over 2 * width * height. Throws as render() does.
nlohmann::ordered_json furnace_json(const RenderScene& scene, const Camera& camera, RenderOptions options,
                                    const RenderProgress& progress, const std::atomic<bool>& stop);

}  // namespace render
