// From hit to hit: all hits of a ray, and rays that leave where others arrived.
#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "hard/room.hpp"
#include "hard/truth.hpp"
#include "oracle/judge.hpp"
#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

/// All hits of a ray, a page at a time; pages are so small that hits at one vertex fall on several.
std::vector<GnomonHit> all_hits(const GnomonScene* scene, const GnomonRay& ray) {
    constexpr std::size_t page_size = 5;
    std::vector<GnomonHit> all, page(page_size);
    std::size_t count = page_size;
    while (count == page_size) {
        const GnomonHit* after = all.empty() ? nullptr : &all.back();
        const GnomonStatus status = gnomon_intersect_all(scene, &ray, after, page_size, page.data(), &count);
        if (status != GNOMON_OK) throw BuildError(status, gnomon_last_error());
        all.insert(all.end(), page.begin(), page.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return all;
}

bool names(const GnomonHit& hit, const Candidate& candidate) {
    return hit.geometry_id == candidate.geometry_id && hit.primitive_id == candidate.primitive_id;
}

/// The exact hits, each once, in their order.
bool are_exact(const std::vector<GnomonHit>& hits, const GnomonRay& ray, const std::vector<Candidate>& candidates) {
    std::vector<Candidate> expected = candidates;
    std::erase_if(expected, [&](const Candidate& c) { return !counts(ray, c); });
    return std::ranges::equal(hits, expected, [](const GnomonHit& h, const Candidate& c) { return names(h, c) && h.t == c.t; });
}

/// Each a candidate, none twice, in the order of t, and none left out that the band does not excuse.
bool are_allowed(const std::vector<GnomonHit>& hits, const GnomonRay& ray, const std::vector<Candidate>& candidates) {
    const auto is_listed = [&](const Candidate& c) {
        return std::ranges::count_if(hits, [&](const GnomonHit& h) { return names(h, c); });
    };
    const bool is_complete = std::ranges::all_of(candidates, [&](const Candidate& c) {
        return is_listed(c) == 1 || (is_listed(c) == 0 && (c.in_band || !counts(ray, c)));
    });
    const bool is_known = std::ranges::all_of(hits, [&](const GnomonHit& h) {
        return std::ranges::any_of(candidates, [&](const Candidate& c) { return names(h, c); });
    });
    return is_complete && is_known && std::ranges::is_sorted(hits, {}, &GnomonHit::t);
}

/// From outside through a vertex or a point of an edge, on through all the mesh.
void run_all_hits(CaseRun& run) {
    const std::vector<Scene> scenes = {generate_scene("icosphere", 320), generate_scene("torus", 600),
                                       generate_scene("cube_grid", 300)};
    for (const Scene& scene : scenes) {
        std::vector<GnomonRay> rays(run.ray_count(scenes.size()));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto triangle = scene.triangle(0, static_cast<std::uint32_t>(run.rng.below(scene.triangle_count())));
            const Vec3f target = between({triangle[0], triangle[1]}, i % 2 == 0 ? 0 : run.rng.uniform());
            rays[i] = ray_towards(to_float(5.0 * unit_direction(run.rng)), target);
        }
        const Truth truth(scene, rays);
        run.each_engine(scene, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
            if (!engine.is_gnomon()) return;  // Embree has no such call
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ++row.checked;
                const std::vector<GnomonHit> hits = all_hits(backend.scene(), rays[i]);
                if (are_exact(hits, rays[i], truth.candidates(i))) continue;
                if (engine.precision != "exact" && are_allowed(hits, rays[i], truth.candidates(i))) {
                    ++row.failed;
                } else {
                    run.fail(row, scene, rays[i], std::to_string(hits.size()) + " hits in all are not the exact ones");
                }
            }
        });
    }
}

/// Points inside of closed meshes and far outside of them.
void run_contained(CaseRun& run) {
    for (const RoomClass& room_class : room_classes()) {
        if (room_class.number != 2 && room_class.number != 10) continue;
        const std::vector<Scene> meshes = room_class.make_meshes();
        for (const Scene& mesh : meshes) {
            const Room room(mesh, run.rng);
            const std::vector<GnomonRay> rays = aim_all(room, room_class.aim, run.ray_count(20), run.rng);
            run.each_engine(mesh, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
                if (!engine.is_gnomon()) return;
                for (GnomonRay ray : rays) {
                    bool is_inside = false, is_outside_inside = true;
                    gnomon_contains_point(backend.scene(), ray.origin, &is_inside);
                    ray.origin[run.rng.below(3)] += 1e6f;
                    gnomon_contains_point(backend.scene(), ray.origin, &is_outside_inside);
                    row.checked += 2;
                    if (!is_inside || is_outside_inside) run.fail(row, mesh, ray, "inside and outside are mixed up");
                }
            });
        }
    }
}

/// A direction that leads back to the side the ray came from, now and then hardly off the surface, but not so little that
/// rounding the normal and the direction to float could change the side.
Vec3f next_direction(const GnomonRay& ray, const Vec3d& normal, Rng& rng) {
    constexpr double least = 0x1p-20;
    const Vec3d unit_normal = normalized(normal);
    const Vec3d direction = unit_direction(rng);
    const double along = dot(direction, unit_normal), kept = rng.below(4) == 0 ? std::pow(10, rng.uniform(-8, -1)) : 1;
    const double wanted = std::copysign(std::max(least, kept * std::abs(along)), -dot(to_double(ray.direction), unit_normal));
    return to_float(direction + (wanted - along) * unit_normal);
}

/// Where a path goes on: from gnomon's bound, or for want of one from origin + t * direction. Nothing where gnomon refuses.
std::optional<GnomonRay> next_ray(const HardEngine& engine, const Backend& backend, const GnomonRay& ray, const GnomonHit& hit,
                                  Rng& rng) {
    GnomonRay next = ray_of({0, 0, 0}, next_direction(ray, to_double(hit.normal), rng));
    if (!engine.is_gnomon()) {
        for (int axis = 0; axis < 3; ++axis) next.origin[axis] = ray.origin[axis] + hit.t * ray.direction[axis];
        return next;
    }
    GnomonSurfacePoint point;
    if (gnomon_surface_point(backend.scene(), &ray, &hit, &point) != GNOMON_OK) return {};
    if (gnomon_offset_origin(&point, next.direction, next.origin) != GNOMON_OK) return {};
    return next;
}

/// Paths inside closed meshes: a ray that hits what it left fails, and one that hits nothing.
void run_secondary_rays(CaseRun& run) {
    constexpr std::size_t bounce_count = 4;
    std::vector<Scene> meshes = {generate_scene("icosphere", 320), generate_scene("torus", 600),
                                 generate_scene("fan_valence", 200), generate_scene("cube_grid", 300)};
    for (const Scene& mesh : meshes) {
        const Room room(mesh, run.rng);
        const std::vector<GnomonRay> first = aim_all(
            room, [](const Room& r, Rng& rng) { return ray_of(r.point(rng), to_float(unit_direction(rng))); },
            run.ray_count(meshes.size()), run.rng);
        run.each_engine(mesh, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
            Rng rng(1);
            std::vector<GnomonRay> rays = first;
            std::vector<GnomonHit> hits = answers_of(backend, rays).hits;
            for (std::size_t bounce = 0; bounce < bounce_count; ++bounce) {
                std::vector<GnomonRay> next;
                std::vector<GnomonHit> left;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    // At t = 0 the origin is on another surface, and which side of that it came from has no answer.
                    if (!is_hit(hits[i]) || (bounce > 0 && hits[i].t <= 0)) continue;
                    const std::optional<GnomonRay> ray = next_ray(engine, backend, rays[i], hits[i], rng);
                    if (!ray) {
                        ++row.checked;
                        run.fail(row, mesh, rays[i], std::string("no way on: ") + gnomon_last_error());
                        continue;
                    }
                    next.push_back(*ray);
                    left.push_back(hits[i]);
                }
                const Answers answers = answers_of(backend, next);
                for (std::size_t i = 0; i < next.size(); ++i) {
                    const GnomonHit& hit = answers.hits[i];
                    const bool is_self_hit = hit.geometry_id == left[i].geometry_id && hit.primitive_id == left[i].primitive_id;
                    ++row.checked;
                    if (!is_hit(hit) && engine.precision == "fast")
                        ++row.failed;
                    else if (!is_hit(hit))
                        run.fail(row, mesh, next[i], "leaves a closed mesh");
                    else if (is_self_hit)
                        run.fail(row, mesh, next[i], "hits what it left: " + hit_text(hit));
                }
                rays = std::move(next);
                hits = answers.hits;
            }
        });
    }
}

}  // namespace

std::vector<HardCase> walk_cases() {
    return {
        {6, "all hits through vertices and edges from outside", "each triangle once; EXACT the exact ones", run_all_hits},
        {6, "points inside and outside of closed meshes", "0 wrong", run_contained, "", "points"},
        {41, "secondary rays from the returned bound (Embree: from origin + t * direction)", "0 self-hits, 0 leaks",
         run_secondary_rays, "FAST computes t in float: a surface that is nearer than that rounds may be passed"},
    };
}

}  // namespace harness
