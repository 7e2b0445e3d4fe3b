#include "render/gltf_camera.hpp"

#include <cmath>
#include <numbers>

#include "scene/load.hpp"

namespace render {

namespace {

constexpr Interval angle_of_view{0, std::numbers::pi, true, "an angle above 0 and below pi"};

double required(const JsonObject& object, const char* key, const Interval& interval) {
    if (!object.has(key)) throw harness::SceneError(object.path() + " has no " + key);
    return object.number(key, 0, interval);
}

}  // namespace

Camera read_camera(const JsonObject& camera, const Frame& frame) {
    Camera view{camera.text("name", ""), frame.position, frame.right, frame.up, frame.forward, 0, 0, false};
    const std::string type = camera.text("type", "");
    if (type == "perspective") {
        const JsonObject perspective = camera.object("perspective");
        view.half_height = std::tan(required(perspective, "yfov", angle_of_view) / 2);
        view.half_width = view.half_height * perspective.number("aspectRatio", 0, positive);
    } else if (type == "orthographic") {
        const JsonObject orthographic = camera.object("orthographic");
        view.is_orthographic = true;
        view.half_height = required(orthographic, "ymag", positive);
        view.half_width = required(orthographic, "xmag", positive);
    } else {
        if (!camera.has("type")) throw harness::SceneError(camera.path() + " has no type");
        camera.fail("type", "perspective or orthographic");
    }
    if (!std::isfinite(float(view.half_width)))
        throw harness::SceneError(camera.path() + ": yfov and aspectRatio make it wider than floats hold");
    return view;
}

}  // namespace render
