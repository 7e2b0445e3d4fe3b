// The rays of a scene: seen from outside, from inside, and at random.
#pragma once

#include <string>
#include <vector>

#include "backend/backend.hpp"
#include "rays/rays.hpp"

namespace harness {

struct View {
    std::string name;  // "outside", "inside"
    Camera camera;
};

/// Both views, most of whose pixels see geometry. Throws SceneError where there is nothing to look at.
std::vector<View> bench_views(const Scene& scene, const Tracer& trace);

struct ViewRays {
    std::string view;  // a View's name; "" for random rays
    RaySet set;
};

/// The most ray sets that bench_rays() makes for two views.
constexpr std::size_t most_ray_sets = 7;

/// Camera, bounce and occlusion rays of each view, and random rays; `count` of each, none of a kind that a view has no rays of.
/// `trace` finds what the later rays start from.
std::vector<ViewRays> bench_rays(const Scene& scene, const std::vector<View>& views, const Tracer& trace, std::size_t count);

/// Any engine's closest hits.
Tracer tracer_of(Backend& backend);

}  // namespace harness
