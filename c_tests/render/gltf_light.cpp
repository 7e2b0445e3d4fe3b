#include "render/gltf_light.hpp"

#include <cmath>
#include <numbers>

#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

using harness::to_float;

/// Files that hold pi / 2 as a float have a little more than pi / 2.
constexpr Interval angle{0, std::numbers::pi_v<float> / 2, false, "an angle from 0 to pi / 2"};

Rgb read_color(const JsonObject& light) {
    const double intensity = light.number("intensity", 1, not_negative);
    const std::vector<double> color = light.numbers("color", {1, 1, 1}, not_negative);
    Rgb product;
    for (std::size_t i = 0; i < 3; ++i) product[i] = float(intensity * color[i]);
    if (!std::isfinite(product[0] + product[1] + product[2]))
        throw harness::SceneError(light.path() + ": intensity times color is beyond the range of floats");
    return product;
}

SpotLight read_spot(const JsonObject& light, const Rgb& intensity_cd, float range_m) {
    const JsonObject spot = light.object("spot");
    const auto inner = float(spot.number("innerConeAngle", 0, angle));
    const auto outer = float(spot.number("outerConeAngle", std::numbers::pi / 4, angle));
    if (!(inner < outer))
        throw harness::SceneError(spot.path() + ": innerConeAngle " + std::to_string(inner) +
                                  " is not less than outerConeAngle " + std::to_string(outer));
    return {{}, {}, intensity_cd, range_m, inner, outer};
}

struct Placement {
    RenderScene& scene;
    Vec3f position, direction;

    void operator()(PointLight light) const {
        light.position = position;
        scene.point_lights.push_back(light);
    }
    void operator()(SpotLight light) const {
        light.position = position;
        light.direction = direction;
        scene.spot_lights.push_back(light);
    }
    void operator()(DirectionalLight light) const {
        light.direction = direction;
        scene.directional_lights.push_back(light);
    }
};

}  // namespace

Light read_light(const JsonObject& light) {
    const std::string type = light.text("type", "");
    const Rgb color = read_color(light);
    const auto range_m = float(light.number("range", INFINITY, positive));
    if (type == "point") return PointLight{{}, color, range_m};
    if (type == "spot") return read_spot(light, color, range_m);
    if (type == "directional") return DirectionalLight{{}, color};
    if (!light.has("type")) throw harness::SceneError(light.path() + " has no type");
    light.fail("type", "point, spot or directional");
}

void add_light(RenderScene& scene, const Light& light, const Frame& frame) {
    std::visit(Placement{scene, to_float(frame.position), to_float(frame.forward)}, light);
}

}  // namespace render
