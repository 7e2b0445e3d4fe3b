// Embree 3 behind the common interface.
#ifdef GNOMON_WITH_EMBREE

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "backend/backend.hpp"
#include "backend/cpu_isa.hpp"
#include "backend/embree_calls.hpp"
#include "backend/embree_packets.hpp"
#include "backend/names.hpp"
#include "backend/trace_loop.hpp"

namespace harness {
namespace {

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

/// Embree's FLT_LARGE: beyond it the assertions of Debian's build end the process.
constexpr float largest_coordinate = 1.844e18f;

/// The mesh's vertices with the twelve further bytes that Embree reads at the last one.
std::vector<float> padded(const std::vector<float>& positions) {
    std::vector<float> copy(positions.size() + 3, 0.0f);
    std::copy(positions.begin(), positions.end(), copy.begin());
    return copy;
}

RTCBuildQuality build_quality(std::uint32_t quality) {
    switch (quality) {
        case GNOMON_QUALITY_LOW:
            return RTC_BUILD_QUALITY_LOW;
        case GNOMON_QUALITY_HIGH:
            return RTC_BUILD_QUALITY_HIGH;
        default:
            return RTC_BUILD_QUALITY_MEDIUM;
    }
}

class EmbreeBackend final : public Backend {
public:
    EmbreeBackend(const Scene& scene, bool robust, std::uint32_t quality, std::uint32_t threads) {
        const std::string config = "threads=" + std::to_string(threads);
        device_.reset(rtcNewDevice(config.c_str()));
        if (!device_) throw BuildError(GNOMON_ERROR_INTERNAL, "Embree gives no device");
        rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, &bytes_);
        scene_.reset(rtcNewScene(device_.get()));
        rtcSetSceneFlags(scene_.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        rtcSetSceneBuildQuality(scene_.get(), build_quality(quality));
        attach_meshes(scene);
        report_.seconds = timed([&] { rtcCommitScene(scene_.get()); });
        if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE) {
            throw BuildError(GNOMON_ERROR_INTERNAL, "Embree fails with error " + std::to_string(error) + " in rtcCommitScene");
        }
        report_.engine = robust ? "embree_robust" : "embree";
        report_.structure = "bvh";
        report_.quality = name_of(quality_names, quality);
        report_.isa = cpu_isa();  // Embree takes the widest and does not name it
        report_.threads = threads;
        report_.triangles = scene.triangle_count();
        report_.bytes = static_cast<std::uint64_t>(bytes_.load());
    }

    void prepare(std::span<const GnomonRay> rays) override {
        rays_.assign(rays.begin(), rays.end());
        for (GnomonRay& ray : rays_) {
            if (!embree_takes(ray)) ray = idle_ray();
        }
        fastest_intersect_ = fastest_occluded_ = nullptr;
    }

    double intersect(CallForm form, std::span<GnomonHit> hits, std::uint32_t threads) override {
        if (form == CallForm::fresh) return embree_fresh.intersect(scene_.get(), rays_, hits, 1);
        if (form == CallForm::prefilled) return embree_prefilled.intersect(scene_.get(), rays_, hits, 1);
        const auto trace = [&](const EmbreeCall& call) { return call.intersect(scene_.get(), rays_, hits, threads); };
        if (!fastest_intersect_) fastest_intersect_ = fastest(trace);
        return trace(*fastest_intersect_);
    }

    double occluded(CallForm form, std::span<std::uint8_t> occluded, std::uint32_t threads) override {
        if (form == CallForm::fresh) return embree_fresh.occluded(scene_.get(), rays_, occluded, 1);
        if (form == CallForm::prefilled) return embree_prefilled.occluded(scene_.get(), rays_, occluded, 1);
        const auto trace = [&](const EmbreeCall& call) { return call.occluded(scene_.get(), rays_, occluded, threads); };
        if (!fastest_occluded_) fastest_occluded_ = fastest(trace);
        return trace(*fastest_occluded_);
    }

    std::string call_name(CallForm form, bool occlusion) const override {
        const EmbreeCall* batch = occlusion ? fastest_occluded_ : fastest_intersect_;
        const EmbreeCall& call = form == CallForm::batch && batch ? *batch : embree_fresh;
        return std::string(occlusion ? call.occluded_name : call.intersect_name);
    }

private:
    static bool count_bytes(void* counter, ssize_t bytes, bool) {
        *static_cast<std::atomic<std::int64_t>*>(counter) += bytes;
        return true;
    }

    void attach_meshes(const Scene& scene) {
        vertices_.reserve(scene.meshes.size());
        for (std::uint32_t mesh_id = 0; mesh_id < scene.meshes.size(); ++mesh_id) {
            const Mesh& mesh = scene.meshes[mesh_id];
            if (mesh.indices.empty()) continue;
            vertices_.push_back(padded(mesh.positions));
            RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices_.back().data(), 0,
                                       3 * sizeof(float), mesh.vertex_count());
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                                       3 * sizeof(std::uint32_t), mesh.triangle_count());
            rtcCommitGeometry(geometry);
            rtcAttachGeometryByID(scene_.get(), geometry, mesh_id);
            rtcReleaseGeometry(geometry);
        }
    }

    /// The batch call with the least time of two rounds over all of them.
    template <class Trace>
    static const EmbreeCall* fastest(Trace trace) {
        const EmbreeCall* best = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (int round = 0; round < 2; ++round) {
            for (const EmbreeCall& call : embree_batch_calls()) {
                const double seconds = trace(call);
                if (seconds < least) {
                    least = seconds;
                    best = &call;
                }
            }
        }
        return best;
    }

    // Outlive the device, which counts what it frees, and the scene, which reads the vertices.
    std::atomic<std::int64_t> bytes_{0};
    std::vector<std::vector<float>> vertices_;
    DeviceHandle device_;
    SceneHandle scene_;

    std::vector<GnomonRay> rays_;
    const EmbreeCall* fastest_intersect_ = nullptr;
    const EmbreeCall* fastest_occluded_ = nullptr;
};

}  // namespace

std::unique_ptr<Backend> make_embree(const Scene& scene, bool robust, std::uint32_t quality, std::uint32_t threads) {
    return std::make_unique<EmbreeBackend>(scene, robust, quality, threads);
}

// Embree's assertions also refuse NaN and t_min < 0; gnomon's contract makes a zero direction and an empty interval misses.
bool embree_takes(const GnomonRay& ray) {
    bool directed = false;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(ray.origin[axis]) <= largest_coordinate) || !(std::abs(ray.direction[axis]) <= largest_coordinate))
            return false;
        directed |= ray.direction[axis] != 0;
    }
    return directed && ray.t_min >= 0 && ray.t_min <= ray.t_max;
}

bool embree_takes(const Scene& scene) {
    return std::ranges::all_of(scene.meshes, [](const Mesh& mesh) {
        return std::ranges::all_of(mesh.positions, [](float x) { return std::abs(x) <= largest_coordinate; });
    });
}

std::string embree_version() { return RTC_VERSION_STRING; }

}  // namespace harness

#endif
