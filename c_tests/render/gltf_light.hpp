// KHR_lights_punctual: lamps without a size.
#pragma once

#include <variant>

#include "render/frame.hpp"
#include "render/json_object.hpp"

namespace render {

/// A lamp, wherever nodes put it.
using Light = std::variant<PointLight, SpotLight, DirectionalLight>;

/// An object of the extension's list, its defaults the extension's: 1 cd or lx, white, no range, a cone from 0 to pi / 4. Throws
/// SceneError for an unknown type, an intensity or colour that is negative or beyond floats, a range that is not positive, and
/// cone angles but 0 <= inner < outer <= pi / 2.
Light read_light(const JsonObject& light);

/// Adds the lamp as it stands in `frame`: no scale changes its intensity or range, as the extension says.
void add_light(RenderScene& scene, const Light& light, const Frame& frame);

}  // namespace render
