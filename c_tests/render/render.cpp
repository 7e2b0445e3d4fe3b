#include "render/render.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "rays/vector.hpp"
#include "render/camera_ray.hpp"
#include "render/path_tracer.hpp"
#include "render/traced_scene.hpp"
#include "render/wave.hpp"
#include "render/whitted.hpp"
#include "scene/load.hpp"

namespace render {

using namespace harness;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void check(const RenderOptions& options) {
    if (options.width < 1 || options.height < 1)
        throw SceneError("a picture of " + std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels");
    if (options.sample_count < 1) throw SceneError(std::to_string(options.sample_count) + " samples a pixel");
}

/// A square of the picture, less at the right and the lower border.
struct Tile {
    static constexpr int side = 32;  // 1024 paths: their rays, hits and states fit the second-level cache
    int left, top, right, bottom;
    int sample_count = 0;  // taken of each pixel so far

    int width() const { return right - left; }
    std::size_t pixel_count() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(bottom - top); }
};

std::vector<Tile> tiles_of(const RenderOptions& options) {
    std::vector<Tile> tiles;
    for (int top = 0; top < options.height; top += Tile::side)
        for (int left = 0; left < options.width; left += Tile::side)
            tiles.push_back({left, top, std::min(left + Tile::side, options.width), std::min(top + Tile::side, options.height)});
    return tiles;
}

/// Numbers for one sample of a pixel alone, so that the picture depends neither on the threads nor on the order of tiles.
Rng rng_of(std::uint64_t seed, std::uint64_t pixel, int sample) {
    return Rng(Rng(Rng(Rng(seed).next() + pixel).next() + static_cast<std::uint64_t>(sample)).next());
}

/// All workers' picture: each tile is one worker's at a time.
class Painter {
public:
    Painter(const TracedScene& traced, const Camera& camera, const RenderOptions& options)
        : traced_(traced), camera_(camera), options_(options), tiles_(tiles_of(options)) {
        sums_.resize(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
    }

    /// Takes more samples of each pixel, on all threads; fewer once `stop` is set.
    void pass(int sample_count, const RenderProgress& progress, const std::atomic<bool>& stop);

    Rendering rendering() const;

private:
    void work(int sample_count, const RenderProgress& progress, const std::atomic<bool>& stop);
    void take_sample(Tile& tile, Wave& wave);
    void start_paths(const Tile& tile, Wave& wave) const;

    const TracedScene& traced_;
    const Camera& camera_;
    const RenderOptions& options_;
    std::vector<Tile> tiles_;
    std::vector<Vec3d> sums_;  // of the samples of each pixel, in nt
    std::atomic<std::size_t> next_tile_ = 0;
    std::atomic<std::uint64_t> ray_count_ = 0;
    std::exception_ptr failure_;
    std::mutex failure_mutex_;
};

void Painter::pass(int sample_count, const RenderProgress& progress, const std::atomic<bool>& stop) {
    next_tile_ = 0;
    const unsigned thread_count =
        options_.thread_count > 0 ? options_.thread_count : std::max(1u, std::thread::hardware_concurrency());
    {
        std::vector<std::jthread> workers;
        for (unsigned worker = 0; worker < thread_count; ++worker) {
            workers.emplace_back([&] {
                try {
                    work(sample_count, progress, stop);
                } catch (...) {
                    const std::scoped_lock lock(failure_mutex_);
                    failure_ = std::current_exception();
                }
            });
        }
    }
    if (failure_) std::rethrow_exception(failure_);
}

void Painter::work(int sample_count, const RenderProgress& progress, const std::atomic<bool>& stop) {
    Wave wave;
    for (std::size_t i = next_tile_++; i < tiles_.size(); i = next_tile_++) {
        Tile& tile = tiles_[i];
        for (int sample = 0; sample < sample_count; ++sample) {
            if (stop && tile.sample_count > 0) break;
            take_sample(tile, wave);
            if (progress) progress(tile.pixel_count());
        }
    }
    ray_count_ += wave.ray_count;
}

void Painter::take_sample(Tile& tile, Wave& wave) {
    start_paths(tile, wave);
    options_.method == Method::path ? trace_paths(traced_, options_, wave) : trace_whitted(traced_, options_, wave);
    std::size_t pixel = 0;
    for (int y = tile.top; y < tile.bottom; ++y) {
        for (int x = tile.left; x < tile.right; ++x, ++pixel) {
            Vec3d& sum =
                sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x)];
            for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += wave.pixels[pixel][channel];
        }
    }
    ++tile.sample_count;
}

void Painter::start_paths(const Tile& tile, Wave& wave) const {
    wave.pixels.assign(tile.pixel_count(), Rgb{0, 0, 0});
    std::uint32_t pixel = 0;
    for (int y = tile.top; y < tile.bottom; ++y) {
        for (int x = tile.left; x < tile.right; ++x, ++pixel) {
            const auto index =
                static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(options_.width) + static_cast<std::uint64_t>(x);
            Path path{pixel, rng_of(options_.seed, index, tile.sample_count)};
            const bool is_only = options_.sample_count == 1;
            const double column = x + (is_only ? 0.5 : path.rng.uniform()), row = y + (is_only ? 0.5 : path.rng.uniform());
            wave.paths.push_back(path);
            wave.rays.push_back(camera_ray(camera_, column / options_.width, row / options_.height));
        }
    }
}

Rendering Painter::rendering() const {
    Rendering rendering;
    rendering.image = {options_.width, options_.height, std::vector<Rgb>(sums_.size())};
    double samples = 0;
    for (const Tile& tile : tiles_) {
        samples += tile.sample_count * static_cast<double>(tile.pixel_count());
        rendering.is_complete = rendering.is_complete && tile.sample_count == options_.sample_count;
        for (int y = tile.top; y < tile.bottom; ++y) {
            for (int x = tile.left; x < tile.right; ++x) {
                const std::size_t index =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x);
                rendering.image.pixels[index] = to_float((1.0 / tile.sample_count) * sums_[index]);
            }
        }
    }
    rendering.samples_per_pixel = samples / static_cast<double>(sums_.size());
    rendering.ray_count = ray_count_;
    return rendering;
}

}  // namespace

Rendering render(const RenderScene& scene, const Camera& camera, const RenderOptions& options, const RenderProgress& progress,
                 const std::atomic<bool>& stop) {
    constexpr int most_samples_of_a_pass = 16;
    check(options);
    const auto build_start = Clock::now();
    const TracedScene traced(scene, options.precision, options.thread_count);
    const double build_seconds = seconds_since(build_start);

    const auto start = Clock::now();
    Painter painter(traced, camera, options);
    // One sample, so that there soon is a picture; then as many as there are, so that few passes wait for their last tile.
    for (int done = 0; done < options.sample_count && !(done > 0 && stop);) {
        const int sample_count = std::min({std::max(1, done), most_samples_of_a_pass, options.sample_count - done});
        painter.pass(sample_count, progress, stop);
        done += sample_count;
    }
    Rendering rendering = painter.rendering();
    rendering.seconds = seconds_since(start);
    rendering.build_seconds = build_seconds;
    return rendering;
}

}  // namespace render
