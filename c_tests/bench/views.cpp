#include "bench/views.hpp"

#include <algorithm>
#include <array>

#include "compare/results.hpp"

namespace harness {
namespace {

constexpr std::uint64_t bounce_seed = 1, shadow_seed = 2, random_seed = 3;

/// Narrows the angle of view until most pixels see geometry: what misses the scene's box measures calls, not traversal.
Camera filled(Camera camera, const Tracer& trace) {
    constexpr double enough = 0.75, narrowing = 0.85;
    constexpr int most_steps = 8;
    Camera best = camera;
    double best_share = sight(camera, trace).hit_share;
    for (int step = 0; step < most_steps && best_share < enough; ++step) {
        camera.half_width *= narrowing;
        camera.half_height *= narrowing;
        const double share = sight(camera, trace).hit_share;
        if (share <= best_share) continue;
        best = camera;
        best_share = share;
    }
    return best;
}

/// The triangles that lie in the middle of the scene by their first corners: without a backdrop, or a few things far off.
Scene middle_of(const Scene& scene) {
    constexpr double left_out = 0.05;  // of the triangles, at each end of each axis
    std::array<std::vector<double>, 3> places;
    for (const Mesh& mesh : scene.meshes) {
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            for (std::size_t axis = 0; axis < 3; ++axis) places[axis].push_back(mesh.positions[3 * mesh.indices[i] + axis]);
        }
    }
    Vec3d lower, upper;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = quantile(places[axis], left_out);
        upper[axis] = quantile(places[axis], 1 - left_out);
    }
    const auto within = [&](const float* position) {
        return std::ranges::all_of(std::array{0, 1, 2},
                                   [&](int axis) { return position[axis] >= lower[axis] && position[axis] <= upper[axis]; });
    };
    Scene middle{scene.name, scene.meshes};
    for (Mesh& mesh : middle.meshes) {
        std::vector<std::uint32_t> indices;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            if (within(&mesh.positions[3 * std::size_t{mesh.indices[i]}]))
                indices.insert(indices.end(), &mesh.indices[i], &mesh.indices[i] + 3);
        }
        mesh.indices = std::move(indices);
    }
    return middle;
}

/// The fuller of two views, both filled; `whole` where there is little between them.
Camera fuller(const Camera& whole, const Camera& part, const Tracer& trace) {
    constexpr double clearly = 0.1;
    const auto shown = [&](const Camera& camera) {
        const Sight seen = sight(camera, trace);
        return seen.hit_share + seen.triangle_share;
    };
    const Camera filled_whole = filled(whole, trace), filled_part = filled(part, trace);
    return shown(filled_part) > shown(filled_whole) + clearly ? filled_part : filled_whole;
}

}  // namespace

std::vector<View> bench_views(const Scene& scene, const Tracer& trace) {
    Scene middle = middle_of(scene);
    if (middle.triangle_count() == 0) middle = scene;
    return {{"outside", fuller(outside_camera(scene), outside_camera(middle), trace)},
            {"inside", fuller(inside_camera(scene, trace), inside_camera(middle, trace), trace)}};
}

std::vector<ViewRays> bench_rays(const Scene& scene, const std::vector<View>& views, const Tracer& trace, std::size_t count) {
    std::vector<ViewRays> sets;
    for (const auto& [name, camera] : views) {
        const RaySet primary = primary_rays(camera, count);
        const std::vector<GnomonHit> hits = trace(primary.rays);
        // A lamp above the roof lights nothing within: there light goes from place to place.
        const auto shadow = name == "inside" ? connection_rays : shadow_rays;
        sets.push_back({name, primary});
        sets.push_back({name, bounce_rays(scene, primary, hits, count, bounce_seed)});
        sets.push_back({name, shadow(scene, primary, hits, count, shadow_seed)});
    }
    sets.push_back({"", random_rays(scene, count, random_seed)});
    return sets;
}

Tracer tracer_of(Backend& backend) {
    return [&backend](const std::vector<GnomonRay>& rays) {
        std::vector<GnomonHit> hits(rays.size());
        backend.prepare(rays);
        backend.intersect(CallForm::batch, hits, 0);
        return hits;
    };
}

}  // namespace harness
