#include "render/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "render/camera.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

constexpr int most_pixels_a_side = 16'384;

const std::map<std::string, Method> method_names = {{"path", Method::path}, {"whitted", Method::whitted}};

std::string is_luminance(const std::string& text) {
    const float nits = std::strtof(text.c_str(), nullptr);
    return nits >= 0 && std::isfinite(nits) ? "" : "\"" + text + "\" is no luminance: a finite number of at least 0";
}

/// CLI11's ranges let it through.
std::string no_nan(const std::string& text) {
    return std::isnan(std::strtod(text.c_str(), nullptr)) ? "\"" + text + "\" is no number" : "";
}

void declare(CLI::App& app, Options& options) {
    RenderOptions& render = options.render;
    app.add_option("SCENE", options.scene, "a .glb or .gltf file, gen:cornell, gen:furnace, or gen:NAME[:TRIANGLES]")->required();
    app.add_option("--out", options.out,
                   "files to write, without their extensions, or a folder: .png, .exr in nt, and _false_color.png")
        ->capture_default_str();
    app.add_option("--width", render.width, "pixels; the height follows from the camera (within 960 x 540)")
        ->check(CLI::Range(1, most_pixels_a_side));
    app.add_option("--height", render.height, "pixels; the width follows from the camera")
        ->check(CLI::Range(1, most_pixels_a_side));
    app.add_option("--samples", render.sample_count, "paths a pixel")->check(CLI::Range(1, 1 << 20))->capture_default_str();
    app.add_option_function<std::string>(
           "--method", [&render](const std::string& name) { render.method = method_names.at(name); },
           "path: all light, by path tracing; whitted: direct light, mirrors and glass")
        ->check(CLI::IsMember(method_names))
        ->default_str("path");
    app.add_option("--camera", options.camera, "its name, or its index in the order of the scene's nodes (0)");
    app.add_option("--environment", options.environment_nt, "luminance of the sky in nt, instead of the scene's")
        ->check(is_luminance);
    app.add_option("--exposure", options.exposure_ev100, "of the .png, as EV at ISO 100 (by the mean luminance)")
        ->check(CLI::Range(-40.0, 60.0))
        ->check(no_nan);
    app.add_flag("--false-color", options.false_color, "also writes luminance as colour, with a scale in nt");
    app.add_option(
        "--furnace", options.furnace_path,
        "instead of pictures, writes as JSON what each method makes of each kind of surface: of gen:furnace all is 1 nt");
    app.add_option("--max-depth", render.max_depth, "bounces of light: 1 is direct light, 0 no limit")
        ->check(CLI::Range(0, 1 << 20))
        ->capture_default_str();
    app.add_option("--threads", render.thread_count, "0: all")->check(CLI::Range(0, 1024))->capture_default_str();
    app.add_option("--seed", render.seed, "of the random numbers: the same picture for the same seed")->capture_default_str();
    app.add_option("--time-limit", options.time_limit_s, "seconds, after which the picture is written as it is")
        ->check(CLI::PositiveNumber);
}

}  // namespace

std::optional<Options> parse_render_options(int argc, char** argv, int& status) {
    Options options;
    CLI::App app{
        "Renders a scene in photometric units: a picture to look at, and one in nt to measure in.\n"
        "Ctrl-C writes the picture as it is, a second one writes nothing. Exit status: 0; 2 for unusable input.",
        "gnomon-render"};
    declare(app, options);
    try {
        app.parse(argc, argv);
        return options;
    } catch (const CLI::Success& success) {
        status = app.exit(success);
    } catch (const CLI::Error& error) {
        std::fprintf(stderr, "gnomon-render: %s\n", error.what());
        status = 2;
    }
    return {};
}

const Camera& find_camera(const RenderScene& scene, const std::string& name_or_index) {
    if (name_or_index.empty()) return scene.cameras.front();
    std::string known;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const Camera& camera = scene.cameras[i];
        if (camera.name == name_or_index) return camera;
        known += (i == 0 ? "" : ", ") + std::to_string(i) + (camera.name.empty() ? "" : " \"" + camera.name + "\"");
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        if (name_or_index == std::to_string(i)) return scene.cameras[i];
    throw harness::SceneError("--camera: no \"" + name_or_index + "\"; there are " + known);
}

void choose_size(RenderOptions& options, const Camera& camera) {
    constexpr int usual_width = 960, usual_height = 540;
    const double aspect = aspect_of(camera);
    const auto pixels = [](double x) { return int(std::lround(std::clamp(x, 1.0, double(most_pixels_a_side)))); };
    if (options.width == 0 && options.height == 0) options.width = pixels(std::min<double>(usual_width, usual_height * aspect));
    if (options.width == 0) options.width = pixels(options.height * aspect);
    if (options.height == 0) options.height = pixels(options.width / aspect);
}

}  // namespace render
