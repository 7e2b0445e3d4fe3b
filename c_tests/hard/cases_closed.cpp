// Closed meshes: no ray from inside gets out, and what an outline decides.
#include "hard/cases.hpp"
#include "hard/room.hpp"
#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

void run_rooms(const RoomClass& room_class, CaseRun& run) {
    std::vector<Scene> meshes = room_class.make_meshes();
    for (Scene& mesh : meshes) {
        const Room room(std::move(mesh), run.rng);
        run.expect_hits(room.scene(), aim_all(room, room_class.aim, run.ray_count(meshes.size()), run.rng));
    }
}

/// Tangents of a sphere through its mesh's vertices and through points of its edges.
void run_silhouettes(CaseRun& run) {
    const auto triangle_counts = {80, 1'000};
    for (const std::size_t triangle_count : triangle_counts) {
        const Scene scene = generate_scene("icosphere", triangle_count);
        std::vector<GnomonRay> rays(run.ray_count(triangle_counts.size()));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto triangle = scene.triangle(0, static_cast<std::uint32_t>(run.rng.below(scene.triangle_count())));
            const Vec3f target = between({triangle[0], triangle[1]}, i % 2 == 0 ? 0 : run.rng.uniform());
            const Vec3d tangent = normalized(cross(to_double(target), unit_direction(run.rng)));
            rays[i] = ray_towards(to_float(to_double(target) - 2.0 * tangent), target);
        }
        run.judge(scene, rays);
    }
}

}  // namespace

std::vector<HardCase> closed_mesh_cases() {
    std::vector<HardCase> cases;
    for (const RoomClass& room_class : room_classes())
        cases.push_back(
            {room_class.number, room_class.name, "0 leaks", [room_class](CaseRun& run) { run_rooms(room_class, run); }});
    cases.push_back({7, "silhouette vertices and edges", "EXACT 0 wrong; 0 outside the contract", run_silhouettes});
    return cases;
}

}  // namespace harness
