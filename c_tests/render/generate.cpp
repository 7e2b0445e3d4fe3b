#include "render/generate.hpp"

#include <utility>

#include "render/camera.hpp"
#include "scene/mesh_parts.hpp"

namespace render {

namespace {

using harness::Mesh;

constexpr std::uint32_t ball_fineness = 64;  // 81,920 triangles: shading knows no smooth normals

Material material(const std::string& name, MaterialKind kind, const Rgb& base_color) {
    Material result;
    result.name = name;
    result.kind = kind;
    result.base_color = base_color;
    return result;
}

void add(RenderScene& scene, Mesh mesh, Material material) {
    mesh.name = material.name;
    scene.surfaces.push_back({std::move(mesh), {}, std::uint32_t(scene.materials.size())});
    scene.materials.push_back(std::move(material));
}

/// Its front is where the corners run counter-clockwise.
Mesh quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    Mesh mesh;
    const std::uint32_t first = harness::add_vertex(mesh, a);
    for (const Vec3d& corner : {b, c, d}) harness::add_vertex(mesh, corner);
    harness::add_quad(mesh, first, first + 1, first + 2, first + 3);
    return mesh;
}

Mesh ball(const Vec3d& centre, double radius) {
    Mesh mesh;
    harness::add_icosphere(mesh, ball_fineness, centre, radius);
    return mesh;
}

}  // namespace

Material grey_material() { return material("grey", MaterialKind::diffuse, {0.5F, 0.5F, 0.5F}); }

RenderScene make_cornell() {
    // x to the right, y up, the camera looks along -z.
    constexpr double side = 5.5;
    constexpr Rgb white{0.73F, 0.73F, 0.73F}, red{0.63F, 0.06F, 0.05F}, green{0.14F, 0.45F, 0.09F};
    const auto corner = [](int x, int y, int z) -> Vec3d { return {x * side, y * side, z * side}; };
    RenderScene scene;
    scene.name = "cornell";
    const auto wall = [&](const char* name, const Rgb& color, const Mesh& mesh) {
        add(scene, mesh, material(name, MaterialKind::diffuse, color));
    };
    wall("floor", white, quad(corner(0, 0, 0), corner(0, 0, 1), corner(1, 0, 1), corner(1, 0, 0)));
    wall("ceiling", white, quad(corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1)));
    wall("back wall", white, quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)));
    wall("left wall", red, quad(corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1)));
    wall("right wall", green, quad(corner(1, 0, 0), corner(1, 0, 1), corner(1, 1, 1), corner(1, 1, 0)));

    Material lamp = material("lamp", MaterialKind::diffuse, white);
    lamp.emission_nt = {5000, 5000, 5000};
    constexpr double x0 = 2.1, x1 = 3.4, z0 = 2.2, z1 = 3.25, lamp_height = side - 0.01;
    add(scene, quad({x0, lamp_height, z0}, {x1, lamp_height, z0}, {x1, lamp_height, z1}, {x0, lamp_height, z1}), lamp);

    add(scene, ball({1.7, 1.01, 1.7}, 1), material("mirror ball", MaterialKind::mirror, {0.95F, 0.95F, 0.95F}));
    add(scene, ball({3.9, 1.01, 3.4}, 1), material("glass ball", MaterialKind::glass, {1, 1, 1}));
    // Far enough for the opening to fill the picture.
    scene.cameras.push_back(looking_at("front", {side / 2, side / 2, side + 7.5}, {side / 2, side / 2, 0}, side / 2 / 7.5, 1));
    return scene;
}

RenderScene make_furnace() {
    constexpr Rgb all{1, 1, 1};
    RenderScene scene;
    scene.name = "furnace";
    add(scene, ball({-2.2, 0, 0}, 1), material("diffuse ball", MaterialKind::diffuse, all));
    add(scene, ball({0, 0, 0}, 1), material("mirror ball", MaterialKind::mirror, all));
    add(scene, ball({2.2, 0, 0}, 1), material("glass ball", MaterialKind::glass, all));
    scene.environment_nt = all;
    scene.cameras.push_back(looking_at("front", {0, 0, 8}, {0, 0, 0}, 0.25, 16.0 / 9));
    return scene;
}

}  // namespace render
