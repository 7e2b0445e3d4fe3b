// gnomon behind the common interface, through its C header alone.
#include <utility>

#include "backend/backend.hpp"
#include "backend/names.hpp"
#include "backend/trace_loop.hpp"
#include "harness/triangles.hpp"

namespace harness {
namespace {

struct FreeBuilder {
    void operator()(GnomonSceneBuilder* builder) const { gnomon_scene_builder_free(builder); }
};
struct FreeScene {
    void operator()(GnomonScene* scene) const { gnomon_scene_free(scene); }
};
using BuilderHandle = std::unique_ptr<GnomonSceneBuilder, FreeBuilder>;
using SceneHandle = std::unique_ptr<GnomonScene, FreeScene>;

void require(GnomonStatus status) {
    if (status != GNOMON_OK) throw BuildError(status, gnomon_last_error());
}

BuilderHandle fill_builder(const Scene& scene) {
    BuilderHandle builder(gnomon_scene_builder_new());
    if (!builder) throw BuildError(GNOMON_ERROR_OUT_OF_MEMORY, gnomon_last_error());
    for (std::uint32_t mesh_id = 0; mesh_id < scene.meshes.size(); ++mesh_id) {
        const Mesh& mesh = scene.meshes[mesh_id];
        const GnomonTriangles triangles = triangles_of(mesh);
        std::uint32_t geometry_id = GNOMON_INVALID_ID;
        require(gnomon_scene_builder_add_triangles(builder.get(), &triangles, &geometry_id));
        if (geometry_id != mesh_id) {
            throw BuildError(GNOMON_ERROR_INTERNAL,
                             "mesh " + std::to_string(mesh_id) + " became geometry " + std::to_string(geometry_id));
        }
    }
    return builder;
}

GnomonRay write_fresh(const GnomonRay& source) {
    GnomonRay ray;
    for (int axis = 0; axis < 3; ++axis) store_field(ray.origin[axis], source.origin[axis]);
    store_field(ray.t_min, source.t_min);
    for (int axis = 0; axis < 3; ++axis) store_field(ray.direction[axis], source.direction[axis]);
    store_field(ray.t_max, source.t_max);
    return ray;
}

class GnomonBackend final : public Backend {
public:
    GnomonBackend(const Scene& scene, const GnomonBuildOptions& options) {
        const BuilderHandle builder = fill_builder(scene);
        GnomonScene* built = nullptr;
        GnomonStatus status = GNOMON_OK;
        report_.seconds = timed([&] { status = gnomon_scene_build(builder.get(), &options, &built); });
        require(status);
        scene_.reset(built);
        fill_report(options);
    }

    void prepare(std::span<const GnomonRay> rays) override { rays_ = rays; }

    double intersect(CallForm form, std::span<GnomonHit> hits, std::uint32_t threads) override {
        const GnomonScene* scene = scene_.get();
        switch (form) {
            case CallForm::fresh:
                return time_each(rays_.size(), [scene, rays = rays_.data(), hits = hits.data()](std::size_t i) {
                    const GnomonRay ray = write_fresh(rays[i]);
                    GnomonHit hit;
                    gnomon_intersect(scene, &ray, &hit);
                    hits[i] = hit;
                });
            case CallForm::prefilled:
                return time_each(rays_.size(), [scene, rays = rays_.data(), hits = hits.data()](std::size_t i) {
                    gnomon_intersect(scene, &rays[i], &hits[i]);
                });
            case CallForm::batch:
                break;
        }
        const GnomonQueryOptions options = query_options(threads);
        return timed([&] { require(gnomon_intersect_n(scene, rays_.data(), rays_.size(), hits.data(), &options)); });
    }

    double occluded(CallForm form, std::span<std::uint8_t> occluded, std::uint32_t threads) override {
        const GnomonScene* scene = scene_.get();
        switch (form) {
            case CallForm::fresh:
                return time_each(rays_.size(), [scene, rays = rays_.data(), occluded = occluded.data()](std::size_t i) {
                    const GnomonRay ray = write_fresh(rays[i]);
                    occluded[i] = gnomon_occluded(scene, &ray);
                });
            case CallForm::prefilled:
                return time_each(rays_.size(), [scene, rays = rays_.data(), occluded = occluded.data()](std::size_t i) {
                    occluded[i] = gnomon_occluded(scene, &rays[i]);
                });
            case CallForm::batch:
                break;
        }
        const GnomonQueryOptions options = query_options(threads);
        return timed([&] { require(gnomon_occluded_n(scene, rays_.data(), rays_.size(), occluded.data(), &options)); });
    }

    void count(std::span<GnomonRayCounts> counts) override {
        GnomonHit hit;
        for (std::size_t i = 0; i < rays_.size(); ++i) gnomon_intersect_counted(scene_.get(), &rays_[i], &hit, &counts[i]);
    }

    const GnomonScene* scene() const override { return scene_.get(); }

    std::string call_name(CallForm form, bool occlusion) const override {
        const std::string single = occlusion ? "gnomon_occluded" : "gnomon_intersect";
        return form == CallForm::batch ? single + "_n" : single;
    }

private:
    static GnomonQueryOptions query_options(std::uint32_t threads) {
        GnomonQueryOptions options;
        gnomon_query_options_init(&options);
        options.thread_count = threads;
        return options;
    }

    void fill_report(const GnomonBuildOptions& options) {
        GnomonSceneStats stats{};
        require(gnomon_scene_stats(scene_.get(), sizeof stats, &stats));
        report_.engine = "gnomon";
        report_.structure = name_of(structure_names, stats.structure);
        report_.quality = name_of(quality_names, options.quality);
        report_.precision = name_of(precision_names, stats.precision);
        report_.isa = name_of(isa_names, stats.isa);
        report_.compact = options.compact != 0 && stats.structure == GNOMON_STRUCTURE_WIDE_BVH;
        report_.threads = options.thread_count;
        report_.triangles = stats.triangle_count;
        report_.bytes = stats.bytes;
        report_.nodes = stats.node_count;
        report_.references = stats.reference_count;
        report_.depth = stats.depth;
        report_.sah_cost = stats.sah_cost;
    }

    SceneHandle scene_;
    std::span<const GnomonRay> rays_;
};

}  // namespace

std::unique_ptr<Backend> make_gnomon(const Scene& scene, const GnomonBuildOptions& options) {
    return std::make_unique<GnomonBackend>(scene, options);
}

}  // namespace harness
