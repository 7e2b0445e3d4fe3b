// Rays from inside closed meshes: each must hit something. The classes are those of accuracy.md.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>

#include "backend/backend.hpp"
#include "compare/describe.hpp"
#include "harness/ray_count.hpp"
#include "harness/rng.hpp"
#include "oracle/oracle.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// The meshes of classes 1 to 5 have a radius of about 1; class 4 moves their vertices to multiples of this.
constexpr double dyadic_step = 0x1p-10;

Vec3f unit_direction(Rng& rng) {
    const double z = rng.uniform(-1, 1), angle = rng.uniform(0, 2 * std::numbers::pi), radius = std::sqrt(1 - z * z);
    return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)), static_cast<float>(z)};
}

GnomonRay ray_of(const Vec3f& origin, const Vec3f& direction) {
    return {{origin[0], origin[1], origin[2]}, 0, {direction[0], direction[1], direction[2]}, infinity};
}

GnomonRay ray_towards(const Vec3f& origin, const Vec3f& target) {
    return ray_of(origin, {target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
}

bool has_direction(const GnomonRay& ray) { return ray.direction[0] != 0 || ray.direction[1] != 0 || ray.direction[2] != 0; }

/// The scene with each coordinate mapped and rounded once.
Scene mapped(Scene scene, const std::function<double(double)>& map) {
    for (Mesh& mesh : scene.meshes)
        for (float& coordinate : mesh.positions) coordinate = static_cast<float>(map(coordinate));
    return scene;
}

Scene snapped(Scene scene) {
    return mapped(std::move(scene), [](double x) { return std::round(x / dyadic_step) * dyadic_step; });
}

Scene moved(const Scene& scene, double scale, double offset) {
    Scene result = mapped(scene, [=](double x) { return scale * x + offset; });
    char where[64];
    std::snprintf(where, sizeof where, " x %g + %g", scale, offset);
    result.name += where;
    return result;
}

/// A closed mesh and points that are inside it for certain.
class Room {
public:
    Room(Scene scene, Rng& rng) : scene_(std::move(scene)) {
        const Oracle oracle(scene_);
        const Bounds box = scene_.bounds();
        constexpr std::size_t point_count = 64;
        while (points_.size() < point_count) {
            Vec3f point;
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = snap(rng.uniform(box.lower[axis], box.upper[axis]), box.upper[axis] - box.lower[axis]);
            if (is_inside(oracle, point, box.upper[0] - box.lower[0], rng)) points_.push_back(point);
        }
    }

    const Scene& scene() const { return scene_; }
    const Vec3f& point(Rng& rng) const { return points_[rng.below(points_.size())]; }

    /// Two vertices of a random triangle; each edge has two triangles.
    std::pair<Vec3f, Vec3f> edge(Rng& rng) const {
        const auto triangle = scene_.triangle(0, static_cast<std::uint32_t>(rng.below(scene_.triangle_count())));
        const std::size_t first = rng.below(3);
        return {triangle[first], triangle[(first + 1) % 3]};
    }

private:
    /// Multiples of the mesh's own step: with them the way to an edge midpoint of class 4 is an exact float.
    static float snap(double x, double extent) {
        const double step = dyadic_step * std::exp2(std::floor(std::log2(extent / 2)));
        return static_cast<float>(std::round(x / step) * step);
    }

    /// An odd number of exact hits ahead in each of some directions, and none of the surface near.
    static bool is_inside(const Oracle& oracle, const Vec3f& point, double extent, Rng& rng) {
        constexpr int direction_count = 8;
        const double clearance = extent / 50;
        for (int i = 0; i < direction_count; ++i) {
            const std::vector<Candidate> candidates = oracle.candidates(ray_of(point, unit_direction(rng)));
            const bool is_clear = std::all_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
                return c.exact_hit && !c.in_band && std::abs(c.t_exact) > clearance;
            });
            const auto ahead = std::count_if(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.t > 0; });
            if (!is_clear || ahead % 2 == 0) return false;
        }
        return true;
    }

    Scene scene_;
    std::vector<Vec3f> points_;
};

using Aim = GnomonRay (*)(const Room&, Rng&);

GnomonRay anywhere(const Room& room, Rng& rng) { return ray_of(room.point(rng), unit_direction(rng)); }

GnomonRay at_vertex(const Room& room, Rng& rng) { return ray_towards(room.point(rng), room.edge(rng).first); }

Vec3f between(const std::pair<Vec3f, Vec3f>& edge, double along) {
    Vec3f point;
    for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = static_cast<float>((1 - along) * edge.first[axis] + along * edge.second[axis]);
    return point;
}

GnomonRay at_edge(const Room& room, Rng& rng) { return ray_towards(room.point(rng), between(room.edge(rng), rng.uniform())); }

GnomonRay at_midpoint(const Room& room, Rng& rng) { return ray_towards(room.point(rng), between(room.edge(rng), 0.5)); }

GnomonRay at_any(const Room& room, Rng& rng) {
    constexpr Aim aims[] = {anywhere, at_vertex, at_edge, at_midpoint};
    return aims[rng.below(std::size(aims))](room, rng);
}

std::unique_ptr<Backend> gnomon_backend(const Scene& scene, std::uint32_t structure, std::uint32_t quality,
                                        std::uint32_t precision) {
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.structure = structure;
    options.quality = quality;
    options.precision = precision;
    return make_gnomon(scene, options);
}

std::vector<std::unique_ptr<Backend>> backends(const Scene& scene) {
    constexpr std::size_t brute_force_triangles = 200;  // more would take most of the suite's time
    std::vector<std::unique_ptr<Backend>> made;
    for (const std::uint32_t precision : {GNOMON_PRECISION_FAST, GNOMON_PRECISION_ACCURATE}) {
        for (const std::uint32_t quality : {GNOMON_QUALITY_LOW, GNOMON_QUALITY_MEDIUM, GNOMON_QUALITY_HIGH}) {
            made.push_back(gnomon_backend(scene, GNOMON_STRUCTURE_BVH, quality, precision));
            made.push_back(gnomon_backend(scene, GNOMON_STRUCTURE_WIDE_BVH, quality, precision));
        }
        if (scene.triangle_count() <= brute_force_triangles)
            made.push_back(gnomon_backend(scene, GNOMON_STRUCTURE_BRUTE_FORCE, GNOMON_QUALITY_MEDIUM, precision));
    }
    for (const bool robust : {false, true})
        if (auto embree = make_embree(scene, robust, GNOMON_QUALITY_MEDIUM, 1)) made.push_back(std::move(embree));
    return made;
}

struct Leaks {
    std::string engine;
    std::size_t ray_count = 0, intersect = 0, occluded = 0;
};

std::string label(const BuildReport& report) {
    return report.engine == "gnomon" ? "gnomon " + report.structure + " " + report.quality + " " + report.precision
                                     : report.engine;
}

/// Counts the misses of one engine; the first few of gnomon's are printed, and fail the test.
void trace(Backend& backend, const Room& room, const std::vector<GnomonRay>& rays, Leaks& leaks) {
    constexpr std::size_t printed = 3;
    std::vector<GnomonHit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    backend.prepare(rays);
    backend.intersect(CallForm::prefilled, hits, 1);
    backend.occluded(CallForm::prefilled, occluded, 1);
    leaks.ray_count += rays.size();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool intersect_leaks = hits[i].geometry_id == GNOMON_INVALID_ID;
        if (!intersect_leaks && occluded[i] != 0) continue;
        leaks.intersect += intersect_leaks;
        leaks.occluded += occluded[i] == 0;
        if (backend.report().engine == "gnomon" && leaks.intersect + leaks.occluded <= 2 * printed)
            FAIL_CHECK(leaks.engine << " leaks in " << room.scene().name << ": " << ray_text(rays[i]));
    }
}

void print(const char* name, const std::vector<Leaks>& all) {
    std::printf("%-30s %-32s %10s %12s %12s\n", name, "engine", "rays", "intersect", "occluded");
    for (const Leaks& leaks : all)
        std::printf("%-30s %-32s %10zu %12zu %12zu\n", "", leaks.engine.c_str(), leaks.ray_count, leaks.intersect,
                    leaks.occluded);
    std::fflush(stdout);
}

/// Shares the rays of a class among its meshes; 0 leaks of gnomon's is what passes.
void check_class(const char* name, const std::vector<Scene>& meshes, Aim aim) {
    const std::size_t ray_count = ray_count_or(1'000'000);
    std::vector<Leaks> all;
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
        Rng rng(mesh);
        const Room room(meshes[mesh], rng);
        std::vector<GnomonRay> rays(ray_count / meshes.size() + 1);
        for (GnomonRay& ray : rays) {
            do ray = aim(room, rng);
            while (!has_direction(ray));  // far from the origin a target may round to the point inside
        }
        for (const auto& backend : backends(room.scene())) {
            const std::string engine = label(backend->report());
            auto leaks = std::find_if(all.begin(), all.end(), [&](const Leaks& known) { return known.engine == engine; });
            if (leaks == all.end()) leaks = all.insert(all.end(), {engine});
            trace(*backend, room, rays, *leaks);
        }
    }
    print(name, all);
    for (const Leaks& leaks : all) {
        if (!leaks.engine.starts_with("gnomon")) continue;
        CAPTURE(leaks.engine);
        CHECK(leaks.intersect == 0);
        CHECK(leaks.occluded == 0);
    }
}

const std::vector<Scene>& closed_meshes() {
    static const std::vector<Scene> meshes = {generate_scene("icosphere", 80),    generate_scene("icosphere", 5'000),
                                              generate_scene("uv_sphere", 5'000), generate_scene("cube_grid", 100),
                                              generate_scene("cube_grid", 5'000), generate_scene("torus", 5'000)};
    return meshes;
}

}  // namespace

TEST_CASE("class_1_random_directions_never_leak") { check_class("1 random", closed_meshes(), anywhere); }

TEST_CASE("class_2_rays_at_vertices_never_leak") { check_class("2 at vertices", closed_meshes(), at_vertex); }

TEST_CASE("class_3_rays_at_shared_edges_never_leak") { check_class("3 at shared edges", closed_meshes(), at_edge); }

TEST_CASE("class_4_rays_at_dyadic_edge_midpoints_never_leak") {
    std::vector<Scene> meshes;
    for (const Scene& mesh : closed_meshes()) meshes.push_back(snapped(mesh));
    check_class("4 at edge midpoints, dyadic", meshes, at_midpoint);
}

TEST_CASE("class_5_vertices_of_valence_3_to_1000_never_leak") {
    std::vector<Scene> meshes;
    for (const std::size_t valence : {3, 4, 5, 8, 30, 100, 300, 1'000}) {
        Scene& mesh = meshes.emplace_back(generate_scene("fan_valence", 2 * valence));
        mesh.name.append(" ").append(std::to_string(valence));
    }
    check_class("5 valence 3 to 1000", meshes, at_any);
}

TEST_CASE("class_8_meshes_far_from_the_origin_never_leak") {
    std::vector<Scene> meshes;
    for (const char* name : {"icosphere", "uv_sphere", "cube_grid", "torus"}) {
        for (const double offset : {1e3, 1e6}) {
            meshes.push_back(moved(generate_scene(name, 1'000), 1, offset));
            meshes.push_back(moved(generate_scene(name, 1'000), 1e3, offset));
        }
    }
    check_class("8 at 1e3 and 1e6", meshes, at_any);
}
