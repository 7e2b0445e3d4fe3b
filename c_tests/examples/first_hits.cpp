// Shoots a row of rays at a quad from C++: a builder and a scene that free themselves, and one batch call.
#include <gnomon.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace {

struct Free {
    void operator()(GnomonSceneBuilder* builder) const { gnomon_scene_builder_free(builder); }
    void operator()(GnomonScene* scene) const { gnomon_scene_free(scene); }
};
using Builder = std::unique_ptr<GnomonSceneBuilder, Free>;
using Scene = std::unique_ptr<GnomonScene, Free>;

void check(GnomonStatus status) {
    if (status != GNOMON_OK) throw std::runtime_error(gnomon_last_error());
}

Scene build_quad() {
    const std::array<float, 12> positions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const std::array<std::uint16_t, 6> indices{0, 1, 2, 0, 2, 3};
    GnomonTriangles quad{};
    quad.positions = positions.data();
    quad.vertex_count = positions.size() / 3;
    quad.indices = indices.data();
    quad.index_format = GNOMON_INDEX_U16;
    quad.triangle_count = indices.size() / 3;

    const Builder builder(gnomon_scene_builder_new());
    std::uint32_t geometry_id = 0;
    check(gnomon_scene_builder_add_triangles(builder.get(), &quad, &geometry_id));
    GnomonScene* scene = nullptr;
    check(gnomon_scene_build(builder.get(), nullptr, &scene));
    return Scene(scene);
}

}  // namespace

int main() try {
    const Scene scene = build_quad();
    std::array<GnomonRay, 5> rays{};
    std::array<GnomonHit, 5> hits{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i] = {{0.3f * float(i), 0.25f, 2}, 0, {0, 0, -1}, 10};
    }
    check(gnomon_intersect_n(scene.get(), rays.data(), rays.size(), hits.data(), nullptr));
    for (const GnomonHit& hit : hits) {
        if (hit.geometry_id == GNOMON_INVALID_ID) {
            std::puts("miss");
        } else {
            std::printf("hit triangle %u at t = %g\n", hit.primitive_id, double(hit.t));
        }
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
