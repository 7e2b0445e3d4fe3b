#include "render/traced_scene.hpp"

#include "harness/triangles.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace render {

using namespace harness;

namespace {

SceneHandle build(const RenderScene& scene, std::uint32_t precision, unsigned thread_count) {
    const BuilderHandle builder = new_builder();
    if (!builder) throw SceneError(gnomon_last_error());
    for (const Surface& surface : scene.surfaces) {
        const GnomonTriangles triangles = triangles_of(surface.mesh);
        require(gnomon_scene_builder_add_triangles(builder.get(), &triangles, nullptr));
    }
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.precision = precision;
    options.thread_count = thread_count;
    GnomonScene* built = nullptr;
    require(gnomon_scene_build(builder.get(), &options, &built));
    return SceneHandle(built);
}

/// Of the sphere around the scene's box.
double radius_m(const GnomonScene* scene) {
    Vec3f lower, upper;
    require(gnomon_scene_bounds(scene, lower.data(), upper.data()));
    return lower[0] <= upper[0] ? 0.5 * length(to_double(upper) - to_double(lower)) : 0;
}

}  // namespace

TracedScene::TracedScene(const RenderScene& of, std::uint32_t precision, unsigned thread_count)
    : scene(of), handle(build(of, precision, thread_count)), lamps(of, radius_m(handle.get())) {}

void require(GnomonStatus status) {
    if (status != GNOMON_OK) throw SceneError(gnomon_last_error());
}

}  // namespace render
