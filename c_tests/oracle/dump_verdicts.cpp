// Writes what the oracle says about some rays as JSON, for second_oracle.py to check: dump_verdicts FILE.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "hard/populations.hpp"
#include "harness/rng.hpp"
#include "oracle/oracle.hpp"
#include "rays/aim.hpp"
#include "scene/load.hpp"

using namespace harness;
using nlohmann::json;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

json hex(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%a", value);
    return buffer;
}

template <class Range>
json hex_list(const Range& values) {
    json list = json::array();
    for (const float value : values) list.push_back(hex(value));
    return list;
}

json to_json(const GnomonRay& ray) {
    return {{"origin", hex_list(ray.origin)},
            {"t_min", hex(ray.t_min)},
            {"direction", hex_list(ray.direction)},
            {"t_max", hex(ray.t_max)}};
}

json to_json(const GnomonHit& hit) {
    return {{"ids", {hit.geometry_id, hit.primitive_id}}, {"t", hex(hit.t)}, {"u", hex(hit.u)}, {"v", hex(hit.v)}};
}

json to_json(const Verdict& verdict) {
    return {{"missed", verdict.missed},
            {"false_hit", verdict.false_hit},
            {"wrong_primitive", verdict.wrong_primitive},
            {"tie", verdict.tie},
            {"outside_contract", verdict.outside_contract},
            {"t_ulps", hex(verdict.t_ulps)},
            {"uv_error", hex(verdict.uv_error)}};
}

json triangles_of(const Scene& scene) {
    json list = json::array();
    for (std::uint32_t geometry = 0; geometry < scene.meshes.size(); ++geometry) {
        for (std::uint32_t primitive = 0; primitive < scene.meshes[geometry].triangle_count(); ++primitive) {
            json vertices = json::array();
            for (const Vec3f& vertex : scene.triangle(geometry, primitive)) vertices.push_back(hex_list(vertex));
            list.push_back({{"ids", {geometry, primitive}}, {"vertices", vertices}});
        }
    }
    return list;
}

/// Rays of one kind in one scene; each takes a random triangle and a random point of the scene's box.
using MakeRay = GnomonRay (*)(const std::array<Vec3f, 3>& triangle, const Vec3f& point, Rng& rng);

GnomonRay ray_through(const Vec3f& origin, const Vec3f& target) {
    return {{origin[0], origin[1], origin[2]},
            -infinity,
            {target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]},
            infinity};
}

GnomonRay at_interior(const std::array<Vec3f, 3>& triangle, const Vec3f& point, Rng& rng) {
    const double u = rng.uniform();
    GnomonRay ray = ray_through(point, point_of(triangle, u, (1 - u) * rng.uniform()));
    ray.t_min = 0;
    ray.t_max = 1.5f;
    return ray;
}

GnomonRay at_vertex(const std::array<Vec3f, 3>& triangle, const Vec3f& point, Rng& rng) {
    return ray_through(point, triangle[rng.below(3)]);
}

GnomonRay at_edge(const std::array<Vec3f, 3>& triangle, const Vec3f& point, Rng& rng) {
    return ray_through(point, point_of(triangle, rng.uniform(), 0));
}

/// Within rounding of the triangle's plane; in it where that is a coordinate plane.
GnomonRay in_plane(const std::array<Vec3f, 3>& triangle, const Vec3f&, Rng& rng) {
    return ray_through(point_of(triangle, 3 + rng.uniform(), rng.uniform(-2, 2)), point_of(triangle, rng.uniform(), 0));
}

GnomonRay grazing(const std::array<Vec3f, 3>& triangle, const Vec3f& point, Rng& rng) {
    GnomonRay ray = in_plane(triangle, point, rng);
    constexpr double angle = 1e-5;
    for (float& component : ray.direction) component = static_cast<float>(component + angle * rng.uniform(-1, 1));
    return ray;
}

Vec3f point_in_box(const Bounds& box, Rng& rng) {
    Vec3f point;
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(rng.uniform(box.lower[axis], box.upper[axis]));
    return point;
}

/// Right and wrong ones: a miss, and each of the nearest candidates with its t and with the float after it.
std::vector<GnomonHit> answers_to(const std::vector<Candidate>& candidates) {
    constexpr std::size_t most_candidates = 3;
    std::vector<GnomonHit> answers = {{infinity, 0, 0, {0, 0, 0}, GNOMON_INVALID_ID, GNOMON_INVALID_ID, GNOMON_INVALID_ID}};
    for (std::size_t i = 0; i < std::min(most_candidates, candidates.size()); ++i) {
        const Candidate& c = candidates[i];
        for (const float t : {c.t, std::nextafter(c.t, infinity)})
            answers.push_back({t, 0.25f, 0.5f, {0, 0, 0}, c.primitive_id, c.geometry_id, GNOMON_INVALID_ID});
    }
    return answers;
}

json findings(const Oracle& oracle, const GnomonRay& ray) {
    json hits = json::array(), verdicts = json::array();
    for (const Candidate& c : oracle.hits(ray))
        hits.push_back({{"ids", {c.geometry_id, c.primitive_id}}, {"t", hex(c.t)}, {"t_exact", hex(c.t_exact)}});
    for (const GnomonHit& answer : answers_to(oracle.candidates(ray)))
        verdicts.push_back({{"answer", to_json(answer)}, {"verdict", to_json(oracle.judge(ray, answer, Contract::exact))}});
    return {{"ray", to_json(ray)}, {"hits", hits}, {"verdicts", verdicts}};
}

json scene_findings(const Scene& scene) {
    constexpr std::size_t rays_a_kind = 10;
    const Oracle oracle(scene);
    const Bounds box = scene.bounds();
    Rng rng(1);
    json rays = json::array();
    for (const MakeRay make : {at_interior, at_vertex, at_edge, grazing, in_plane}) {
        for (std::size_t i = 0; i < rays_a_kind; ++i) {
            const auto geometry = static_cast<std::uint32_t>(rng.below(scene.meshes.size()));
            const auto primitive = static_cast<std::uint32_t>(rng.below(scene.meshes[geometry].triangle_count()));
            rays.push_back(findings(oracle, make(scene.triangle(geometry, primitive), point_in_box(box, rng), rng)));
        }
    }
    return {{"name", scene.name}, {"triangles", triangles_of(scene)}, {"rays", rays}};
}

json population_findings(const Population& population) {
    constexpr std::size_t rays_a_population = 8;
    Rng rng(1);
    const Trial trial = population.make(rays_a_population, rng);
    const Oracle oracle(trial.scene);
    json rays = json::array();
    for (const GnomonRay& ray : trial.rays) rays.push_back(findings(oracle, ray));
    return {{"name", population.name}, {"triangles", triangles_of(trial.scene)}, {"rays", rays}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: dump_verdicts FILE\n";
        return 2;
    }
    json scenes = json::array();
    for (const char* name : {"soup", "needles", "icosphere", "cube_grid", "height_field", "shells", "identical"})
        scenes.push_back(scene_findings(generate_scene(name, std::string_view(name) == "identical" ? 10 : 200)));
    for (const Population& population : populations()) scenes.push_back(population_findings(population));
    std::ofstream file(argv[1]);
    file << json{{"scenes", scenes}} << '\n';
    if (!file.flush()) {
        std::cerr << "dump_verdicts: cannot write " << argv[1] << '\n';
        return 2;
    }
}
