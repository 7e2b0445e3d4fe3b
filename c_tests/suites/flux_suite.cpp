// Light is neither lost nor made: what a point source sends arrives on the mesh around it, and nothing from outside a closed one.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numbers>

#include "backend/names.hpp"
#include "harness/parallel_for.hpp"
#include "harness/ray_count.hpp"
#include "harness/rng.hpp"
#include "light/half_hidden.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double flux_lm = 815;

/// A mesh, and a source inside and one outside it.
struct Body {
    Scene scene;
    Vec3f inside, outside;
    bool is_closed = true;
};

std::vector<Body> bodies() {
    std::vector<Body> all{{generate_scene("icosphere", 5'000), {0.2F, -0.1F, 0.3F}, {2, 1, 0.5F}},
                          {generate_scene("cube_grid", 1'200), {0.3F, 0.2F, -0.4F}, {3, -2, 1}},
                          {generate_scene("torus", 5'000), {1, 0, 0.05F}, {0, 0, 0.1F}}};
    const std::string path = GNOMON_SHARED_SCENES "/stanford_bunny.glb";
    if (!std::filesystem::exists(path)) {
        std::printf("without %s, which is missing\n", path.c_str());
        return all;
    }
    Scene bunny = load_scene(path);
    const Bounds bounds = bunny.bounds();
    const Vec3d middle = 0.5 * (bounds.lower + bounds.upper), size = bounds.upper - bounds.lower;
    all.push_back({std::move(bunny), to_float(middle - Vec3d{0, 0.1 * size[1], 0}), to_float(bounds.upper + size),
                   false});  // the scan has holes below, through which a percent of the light escapes
    return all;
}

/// Runs work(begin, end, seed) on parts of `count`.
template <class Work>
void in_parts(std::size_t count, Work work) {
    constexpr std::size_t part = 10'000;
    parallel_for((count + part - 1) / part, [&](std::size_t i) { work(i * part, std::min(count, (i + 1) * part), i); });
}

GnomonRay ray_of(const Vec3f& origin) { return {{origin[0], origin[1], origin[2]}, 0, {}, infinity}; }

/// The share of directions from the source in which nothing is hit.
double escaped_share(const SceneHandle& scene, const Vec3f& source, std::size_t count) {
    std::atomic<std::size_t> escaped = 0;
    in_parts(count, [&](std::size_t begin, std::size_t end, std::uint64_t seed) {
        Rng rng(seed);
        std::size_t own = 0;
        for (std::size_t i = begin; i < end; ++i) {
            GnomonDirectionSample sample;
            GnomonRay ray = ray_of(source);
            gnomon_sample_sphere(rng.uniform(), rng.uniform(), &sample);
            std::copy_n(sample.direction, 3, ray.direction);
            own += !gnomon_occluded(scene.get(), &ray);
        }
        escaped += own;
    });
    return double(escaped) / double(count);
}

/// Triangles, each chosen as often as it is large.
class Surface {
public:
    explicit Surface(const Scene& scene) : scene_(scene) {
        for (std::uint32_t geometry_id = 0; geometry_id < scene.meshes.size(); ++geometry_id) {
            for (std::uint32_t id = 0; id < scene.meshes[geometry_id].triangle_count(); ++id) {
                const auto [a, b, c] = scene.triangle(geometry_id, id);
                area_ += length(cross(to_double(b) - to_double(a), to_double(c) - to_double(a))) / 2;
                ids_.push_back({geometry_id, id}), sums_.push_back(area_);
            }
        }
    }

    double area() const { return area_; }

    /// A random point, by a ray through it.
    GnomonSurfacePoint sample(const SceneHandle& built, Rng& rng) const {
        const std::size_t at = std::size_t(std::ranges::lower_bound(sums_, rng.uniform() * area_) - sums_.begin());
        const auto [geometry_id, id] = ids_[std::min(at, ids_.size() - 1)];
        const auto [a, b, c] = scene_.triangle(geometry_id, id);
        const double root = std::sqrt(rng.uniform()), v = rng.uniform() * root;
        const Vec3d ab = to_double(b) - to_double(a), ac = to_double(c) - to_double(a);
        const Vec3d point = to_double(a) + (root - v) * ab + v * ac;
        const Vec3d back = (1 / std::sqrt(length(cross(ab, ac)))) * cross(ab, ac);
        GnomonRay ray = ray_of(to_float(point + back));
        for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = float(-back[std::size_t(axis)]);
        const GnomonHit hit{1, 0, 0, {}, id, geometry_id, GNOMON_INVALID_ID};
        GnomonSurfacePoint found;
        // Right at an edge the ray's rounding may pass the triangle: another point then.
        return gnomon_surface_point(built.get(), &ray, &hit, &found) == GNOMON_OK ? found : sample(built, rng);
    }

private:
    const Scene& scene_;
    double area_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ids_;
    std::vector<double> sums_;
};

struct Arrived {
    double flux_lm, standard_error_lm;
    std::size_t rays, needless;  // those of points that the source is behind
};

/// The integral of what arrives on the back of all triangles, which is the inner side.
Arrived arrived_inside(const Body& body, const SceneHandle& built, const Vec3f& source, std::size_t count) {
    const Surface surface(body.scene);
    const GnomonPointSource lamp{{source[0], source[1], source[2]}, float(gnomon_isotropic_intensity_cd(flux_lm)), 0};
    GnomonSources sources{};
    sources.struct_size = sizeof sources;
    sources.points = &lamp, sources.point_count = 1;
    std::vector<double> sums((count + 9'999) / 10'000), squares(sums.size());
    std::atomic<std::size_t> rays = 0, needless = 0, failures = 0;
    in_parts(count, [&](std::size_t begin, std::size_t end, std::uint64_t part) {
        Rng rng(part + 1);
        std::size_t own_rays = 0, own_needless = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const GnomonSurfacePoint point = surface.sample(built, rng);
            const float inward[3] = {-point.normal[0], -point.normal[1], -point.normal[2]};
            float origin[3];
            GnomonIrradiance answer;
            if (gnomon_offset_origin(&point, inward, origin) != GNOMON_OK ||
                gnomon_irradiance(nullptr, &sources, origin, inward, nullptr, &answer) != GNOMON_OK) {
                ++failures;
                continue;
            }
            const bool faces = answer.illuminance_lx > 0;
            if (gnomon_irradiance(built.get(), &sources, origin, inward, nullptr, &answer) != GNOMON_OK) ++failures;
            own_rays += answer.ray_count;
            own_needless += answer.ray_count > (faces ? 1 : 0);
            sums[part] += answer.illuminance_lx, squares[part] += answer.illuminance_lx * answer.illuminance_lx;
        }
        rays += own_rays, needless += own_needless;
    });
    REQUIRE(failures == 0);
    double sum = 0, square = 0;
    for (std::size_t part = 0; part < sums.size(); ++part) sum += sums[part], square += squares[part];
    const double mean = sum / double(count);
    return {mean * surface.area(), surface.area() * std::sqrt((square / double(count) - mean * mean) / double(count)), rays,
            needless};
}

}  // namespace

TEST_CASE("flux_of_a_source_inside_arrives_on_the_mesh_and_that_of_one_outside_does_not") {
    const std::size_t count = ray_count_or(1'000'000);
    std::printf("%-16s %10s %12s %22s %22s\n", "mesh", "triangles", "escaped", "arrived, lm of 815", "from outside, lm");
    for (const Body& body : bodies()) {
        CAPTURE(body.scene.name);
        const SceneHandle built = build_meshes(body.scene.meshes);
        const double escaped = escaped_share(built, body.inside, count);
        const Arrived arrived = arrived_inside(body, built, body.inside, count),
                      leaked = arrived_inside(body, built, body.outside, count);
        std::printf("%-16s %10zu %12.6f %14.2f +- %4.2f %22g\n", body.scene.name.c_str(), body.scene.triangle_count(), escaped,
                    arrived.flux_lm, arrived.standard_error_lm, leaked.flux_lm);
        std::fflush(stdout);
        const double expected = flux_lm * (1 - escaped);
        CHECK(std::abs(arrived.flux_lm - expected) < std::min(0.01 * flux_lm, 4 * arrived.standard_error_lm));
        CHECK(arrived.needless == 0);
        if (!body.is_closed) continue;
        CHECK(escaped == 0);
        CHECK(leaked.flux_lm == 0);
    }
}

TEST_CASE("box_with_a_lid_is_black_inside") {
    const std::size_t count = ray_count_or(1'000'000);
    // Half a box as deep, and its lid; the lamps around it are bright.
    const Scene box = generate_scene("cube_grid", 12);
    const GnomonPointSource lamps[] = {{{0, 0, 3}, 1e6F, 0}, {{1.5F, 1.5F, 1.5F}, 1e6F, 0}, {{-1.0001F, 0, 0}, 1e6F, 0}};
    const GnomonDirectionalSource sun{{0.3F, -0.2F, -1}, 1e5F};
    const GnomonSphereSource bulb{{0, 3, 0}, 1, 1e6F};
    GnomonSources sources{};
    sources.struct_size = sizeof sources;
    sources.points = lamps, sources.point_count = std::size(lamps);
    sources.directionals = &sun, sources.directional_count = 1;
    sources.spheres = &bulb, sources.sphere_count = 1;
    for (const NamedValue& structure : structure_names) {
        for (const NamedValue& precision : precision_names) {
            if (structure.value == GNOMON_STRUCTURE_AUTO) continue;
            CAPTURE(structure.name);
            CAPTURE(precision.name);
            const SceneHandle built = build_meshes(box.meshes, structure.value, precision.value);
            GnomonIrradianceOptions options;
            gnomon_irradiance_options_init(&options);
            options.sample_count = 64, options.thread_count = 1;
            std::atomic<std::size_t> rays = 0, lit = 0, failures = 0;
            constexpr std::size_t rays_of_point = 64;
            in_parts(count / rays_of_point / (std::size(structure_names) - 1) + 1, [&](std::size_t begin, std::size_t end,
                                                                                       std::uint64_t seed) {
                Rng rng(seed);
                for (std::size_t i = begin; i < end; ++i) {
                    // Anywhere inside, now and then right at a wall.
                    Vec3f point, normal;
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        point[axis] = float(rng.uniform(-1, 1));
                        if (rng.below(4) == 0) point[axis] = std::copysign(1 - 0x1p-24F, point[axis]);
                        normal[axis] = float(rng.uniform(-1, 1));
                    }
                    GnomonIrradiance answer;
                    if (gnomon_irradiance(built.get(), &sources, point.data(), normal.data(), &options, &answer) != GNOMON_OK)
                        ++failures;
                    rays += answer.ray_count, lit += answer.illuminance_lx != 0;
                }
            });
            CHECK(failures == 0);
            CHECK(lit == 0);
        }
    }
}
