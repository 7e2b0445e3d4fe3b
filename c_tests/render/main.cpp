// gnomon-render: pictures of a scene in photometric units.
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/progress.hpp"
#include "harness/write_file.hpp"
#include "render/camera.hpp"
#include "render/exr.hpp"
#include "render/false_color.hpp"
#include "render/furnace.hpp"
#include "render/load.hpp"
#include "render/options.hpp"
#include "render/tone_map.hpp"

namespace {

using namespace render;
using Clock = std::chrono::steady_clock;

constexpr int unusable_input = 2;

std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // or a signal handler may not touch it

void stop_at_interrupt() {
    std::signal(SIGINT, [](int) {
        stop = true;
        std::signal(SIGINT, SIG_DFL);  // the second one ends the program
    });
}

std::uint64_t pixel_count(const RenderOptions& options) { return std::uint64_t(options.width) * std::uint64_t(options.height); }

/// Counts samples as done, and sets `stop` when the time is up.
RenderProgress in_time(harness::Progress& progress, double time_limit_s) {
    return [&progress, time_limit_s, start = Clock::now()](std::uint64_t sample_count) {
        progress.advance(sample_count);
        if (time_limit_s > 0 && std::chrono::duration<double>(Clock::now() - start).count() > time_limit_s) stop = true;
    };
}

/// Where the files go, without extensions; the folder is made.
std::string out_path(const Options& options, const RenderScene& scene) {
    std::filesystem::path path = options.out;
    if (!path.has_filename() || std::filesystem::is_directory(path)) path /= scene.name;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
    return path.string();
}

void write_pictures(const Image& image, const Options& options, const std::string& path) {
    const double exposure = options.exposure_ev100.value_or(automatic_exposure(image));
    write_exr(image, path + ".exr");
    write_png(tone_mapped(image, exposure), path + ".png");
    std::printf("wrote %s.png (EV %.1f) and %s.exr (nt)\n", path.c_str(), exposure, path.c_str());
    if (!options.false_color) return;
    write_png(false_colored(image), path + "_false_color.png");
    std::printf("wrote %s_false_color.png\n", path.c_str());
}

void write_furnace(const RenderScene& scene, const Camera& camera, const Options& options) {
    constexpr std::uint64_t method_count = 2;
    harness::Progress progress(method_count * pixel_count(options.render), scene.name);
    const auto json = furnace_json(scene, camera, options.render, in_time(progress, options.time_limit_s), stop);
    harness::write_file(options.furnace_path, json.dump(2) + "\n");
    std::printf("wrote %s\n", options.furnace_path.c_str());
}

/// The bar is gone when it returns.
Rendering render_visibly(const RenderScene& scene, const Camera& camera, const Options& options) {
    harness::Progress progress(pixel_count(options.render) * std::uint64_t(options.render.sample_count), scene.name);
    return render::render(scene, camera, options.render, in_time(progress, options.time_limit_s), stop);
}

void write_rendering(const RenderScene& scene, const Camera& camera, const Options& options) {
    const std::string path = out_path(options, scene);  // before the work, which a bad path would waste
    const Rendering rendering = render_visibly(scene, camera, options);
    std::printf("%s: %d x %d, %.1f samples a pixel%s, in %.1f s (build %.2f s): %.2f Mray/s; mean luminance %.4g nt\n",
                scene.name.c_str(), rendering.image.width, rendering.image.height, rendering.samples_per_pixel,
                rendering.is_complete ? "" : " (stopped)", rendering.seconds, rendering.build_seconds,
                double(rendering.ray_count) / rendering.seconds / 1e6, mean_luminance(rendering.image));
    write_pictures(rendering.image, options, path);
}

void run(Options options) {
    std::vector<std::string> remarks;
    const RenderScene scene = load_render_scene(options.scene, remarks, options.environment_nt);
    for (const std::string& remark : remarks) std::fprintf(stderr, "gnomon-render: %s\n", remark.c_str());
    const Camera& camera = find_camera(scene, options.camera);
    choose_size(options.render, camera);
    const Camera view = fitted(camera, options.render.width, options.render.height);
    stop_at_interrupt();
    options.furnace_path.empty() ? write_rendering(scene, view, options) : write_furnace(scene, view, options);
}

}  // namespace

int main(int argc, char** argv) {
    int status = 0;
    const std::optional<Options> options = parse_render_options(argc, argv, status);
    if (!options) return status;
    try {
        run(*options);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gnomon-render: %s\n", error.what());
        return unusable_input;
    }
}
