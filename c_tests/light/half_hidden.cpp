#include "light/half_hidden.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "harness/triangles.hpp"
#include "light/closed_forms.hpp"
#include "rays/vector.hpp"

namespace harness {
namespace {

constexpr float lamp_z = 2, screen_z = 1;
// The screen reaches so far that nothing of a lamp is seen beyond its other sides.
constexpr float far_away = 64;

void require(GnomonStatus status) {
    if (status != GNOMON_OK) throw std::runtime_error(gnomon_last_error());
}

/// A multiple of 2^-20, which is a float as it is: what is computed from it in double knows no other number.
float exact(double coordinate) { return float(std::round(0x1p20 * coordinate) * 0x1p-20); }

float random(Rng& rng, double most) { return exact(rng.uniform(-most, most)); }

/// A screen from far away up to the plane through the point and `edge_x` at the lamp's height.
Mesh screen_up_to(const Vec3f& point, double edge_x) {
    const double share = (screen_z - double(point[2])) / (lamp_z - double(point[2]));
    const float end = exact(point[0] + share * (edge_x - point[0]));
    return horizontal_rectangle({-far_away, -far_away, screen_z}, {end, far_away, screen_z}, false);
}

/// Where the screen's edge, a float, is seen at the lamp's height.
double seen_edge(const Mesh& screen, const Vec3f& point) {
    const double end = screen.positions[3], share = (screen_z - double(point[2])) / (lamp_z - double(point[2]));
    return point[0] + (end - point[0]) / share;
}

std::vector<Vec3d> lamp_from(double x) { return {{x, -1, lamp_z}, {1, -1, lamp_z}, {1, 1, lamp_z}, {x, 1, lamp_z}}; }

}  // namespace

const char* name_of(LampKind kind) {
    switch (kind) {
        case LampKind::rectangle:
            return "rectangle";
        case LampKind::rectangle_on_horizon:
            return "rectangle on the horizon";
        case LampKind::sphere:
            return "sphere";
    }
    throw std::logic_error("no such lamp");
}

Mesh horizontal_rectangle(const Vec3f& lower, const Vec3f& upper, bool faces_up) {
    Mesh mesh{"rectangle", {}, {0, 1, 2, 0, 2, 3}};
    for (const auto& [x, y] : {std::pair{lower[0], lower[1]}, {upper[0], lower[1]}, {upper[0], upper[1]}, {lower[0], upper[1]}})
        mesh.positions.insert(mesh.positions.end(), {x, y, lower[2]});
    if (!faces_up) mesh.indices = {0, 2, 1, 0, 3, 2};
    return mesh;
}

HalfHidden half_hidden(LampKind kind, Rng& rng) {
    HalfHidden place{};
    const double most_tilt = kind == LampKind::rectangle_on_horizon ? 4 : 0.2;
    place.point = {random(rng, 1), random(rng, 1), random(rng, 0.5)};
    place.normal = {random(rng, most_tilt), random(rng, most_tilt), 1};
    const Vec3d point = to_double(place.point), normal = normalized(to_double(place.normal));
    const double edge_x = rng.uniform(-0.5, 0.5);
    if (kind == LampKind::sphere) {
        place.sphere = {{0, 0, lamp_z}, 0.75F, lamp_luminance_nt};
        place.screen = screen_up_to(place.point, edge_x);
        const Vec3d to_edge = Vec3d{seen_edge(place.screen, place.point), point[1], lamp_z} - point;
        const Vec3d side = normalized({to_edge[2], 0, -to_edge[0]});
        const Vec3d centre{0, 0, lamp_z};
        const double hidden = projected_half_sphere_sr(point, normal, centre, place.sphere.radius, -side);
        place.visible_lx = lamp_luminance_nt * projected_half_sphere_sr(point, normal, centre, place.sphere.radius, side);
        place.whole_lx = place.visible_lx + lamp_luminance_nt * hidden;
        return place;
    }
    place.rectangle = horizontal_rectangle({-1, -1, lamp_z}, {1, 1, lamp_z}, false);
    place.screen = screen_up_to(place.point, edge_x);
    const auto illuminance_lx = [&](double from) {
        return lamp_luminance_nt * projected_polygon_sr(point, normal, lamp_from(from));
    };
    place.whole_lx = illuminance_lx(-1);
    place.visible_lx = illuminance_lx(seen_edge(place.screen, place.point));
    // Where the horizon leaves little of the lamp or of one of its parts, or all of it, another place.
    const auto below = std::ranges::count_if(lamp_from(-1), [&](const Vec3d& corner) { return dot(normal, corner - point) < 0; });
    const bool is_cut = below > 0, is_wanted = is_cut == (kind == LampKind::rectangle_on_horizon);
    const double share = place.visible_lx / place.whole_lx;
    return is_wanted && place.whole_lx > 1 && share > 0.15 && share < 0.85 ? place : half_hidden(kind, rng);
}

LampSources::LampSources(const HalfHidden& place) : area_{triangles_of(place.rectangle), lamp_luminance_nt, 0}, sources_{} {
    sources_.struct_size = sizeof sources_;
    sources_.areas = &area_, sources_.area_count = 1;
    sources_.spheres = &place.sphere, sources_.sphere_count = place.sphere.radius > 0 ? 1 : 0;
}

GnomonIrradiance irradiance_at(const HalfHidden& place, const GnomonScene* scene, std::uint64_t sample_count, std::uint64_t seed,
                               std::uint32_t thread_count) {
    GnomonIrradianceOptions options;
    gnomon_irradiance_options_init(&options);
    options.sample_count = sample_count, options.seed = seed, options.thread_count = thread_count;
    const LampSources sources(place);
    GnomonIrradiance answer;
    require(gnomon_irradiance(scene, &sources.get(), place.point.data(), place.normal.data(), &options, &answer));
    return answer;
}

SceneHandle build_meshes(const std::vector<Mesh>& meshes, std::uint32_t structure, std::uint32_t precision) {
    const BuilderHandle builder = new_builder();
    for (const Mesh& mesh : meshes) {
        const GnomonTriangles triangles = triangles_of(mesh);
        require(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr));
    }
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.structure = structure, options.precision = precision;
    GnomonScene* scene = nullptr;
    require(gnomon_scene_build(builder.get(), &options, &scene));
    return SceneHandle(scene);
}

}  // namespace harness
