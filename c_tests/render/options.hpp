// What the command line asks for.
#pragma once

#include <optional>
#include <string>

#include "render/render.hpp"

namespace render {

struct Options {
    std::string scene;
    std::string out = "build/render/";  // without extensions; of a folder: named after the scene in it
    std::string camera;                 // a name or an index; empty: the first
    RenderOptions render{0, 0};         // width and height 0: the camera's shape, within 960 x 540
    std::optional<float> environment_nt;
    std::optional<double> exposure_ev100;
    bool false_color = false;
    std::string furnace_path;  // where not empty, no pictures
    double time_limit_s = 0;   // 0: none
};

/// Empty where the program has no more to do: after --help, or after one line about what is wrong. `status` is then its exit
/// status.
std::optional<Options> parse_render_options(int argc, char** argv, int& status);

/// By its name, else by its index. Throws harness::SceneError that lists what there is.
const Camera& find_camera(const RenderScene& scene, const std::string& name_or_index);

/// Fills in a width or height of 0: the camera's shape is kept.
void choose_size(RenderOptions& options, const Camera& camera);

}  // namespace render
