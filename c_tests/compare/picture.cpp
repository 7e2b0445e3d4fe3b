#include "compare/picture.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "rays/vector.hpp"

namespace harness {
namespace {

constexpr int samples_per_axis = 2;
constexpr int sample_width = picture_width * samples_per_axis, sample_height = picture_height * samples_per_axis;

/// The same view with room for the picture's shape.
Camera framed(Camera camera) {
    constexpr double aspect = static_cast<double>(picture_width) / picture_height, margin = 1.06;
    const double half_height = margin * std::max(camera.half_height, camera.half_width / aspect);
    camera.half_height = half_height;
    camera.half_width = half_height * aspect;
    return camera;
}

std::vector<GnomonRay> sample_rays(const Camera& camera) {
    std::vector<GnomonRay> rays;
    rays.reserve(std::size_t{sample_width} * sample_height);
    for (int row = 0; row < sample_height; ++row) {
        for (int column = 0; column < sample_width; ++column) {
            rays.push_back(camera.ray((column + 0.5) / sample_width, (row + 0.5) / sample_height));
        }
    }
    return rays;
}

/// Clay tinted a little by the normal, so that faces of equal brightness stay apart.
Vec3d shade(const Camera& camera, const GnomonHit& hit) {
    const Vec3d geometric = to_double(hit.normal);
    const double area = length(geometric);
    if (!(area > 0)) return {};
    const Vec3d unit = (1 / area) * geometric;
    const Vec3d normal = dot(unit, camera.forward) > 0 ? -unit : unit;
    const Vec3d towards_light = normalized(-camera.forward + 0.7 * camera.up - 0.6 * camera.right);
    const double brightness = 0.3 + 0.7 * std::max(0.0, dot(normal, towards_light));
    const Vec3d tint = {0.5 + 0.5 * dot(normal, camera.right), 0.5 + 0.5 * dot(normal, camera.up), 0.75};
    return brightness * (0.75 * Vec3d{0.86, 0.85, 0.83} + 0.25 * tint);
}

struct Pixel {
    std::uint8_t red, green, blue, alpha;
};

std::uint8_t to_byte(double value) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

/// The mean of a pixel's samples; those that hit nothing make it transparent.
Pixel resolve(const Camera& camera, const std::vector<GnomonHit>& hits, int column, int row) {
    Vec3d sum{};
    int covered = 0;
    for (int y = row * samples_per_axis; y < (row + 1) * samples_per_axis; ++y) {
        for (int x = column * samples_per_axis; x < (column + 1) * samples_per_axis; ++x) {
            const GnomonHit& hit = hits[static_cast<std::size_t>(y) * sample_width + static_cast<std::size_t>(x)];
            if (hit.geometry_id == GNOMON_INVALID_ID) continue;
            sum = sum + shade(camera, hit);
            ++covered;
        }
    }
    if (covered == 0) return {};
    const Vec3d mean = (1.0 / covered) * sum;
    constexpr double samples = samples_per_axis * samples_per_axis;
    return {to_byte(mean[0]), to_byte(mean[1]), to_byte(mean[2]), to_byte(covered / samples)};
}

void append_bytes(void* file, void* data, int size) {
    static_cast<std::string*>(file)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

std::string render_picture(Backend& backend, const Camera& camera) {
    const Camera view = framed(camera);
    const std::vector<GnomonRay> rays = sample_rays(view);
    std::vector<GnomonHit> hits(rays.size());
    backend.prepare(rays);
    backend.intersect(CallForm::prefilled, hits, 1);

    std::vector<Pixel> pixels;
    pixels.reserve(std::size_t{picture_width} * picture_height);
    for (int row = 0; row < picture_height; ++row) {
        for (int column = 0; column < picture_width; ++column) pixels.push_back(resolve(view, hits, column, row));
    }
    std::string file;
    stbi_write_png_to_func(append_bytes, &file, picture_width, picture_height, sizeof(Pixel), pixels.data(),
                           picture_width * static_cast<int>(sizeof(Pixel)));
    return file;
}

}  // namespace harness
