#include "render/lamp_rays.hpp"

#include "render/rgb.hpp"
#include "render/traced_scene.hpp"

namespace render {

using namespace harness;

namespace {

GnomonQueryOptions this_thread() {
    GnomonQueryOptions options;
    gnomon_query_options_init(&options);
    options.thread_count = 1;
    return options;
}

}  // namespace

void intersect_all(const GnomonScene* scene, std::span<const GnomonRay> rays, std::vector<GnomonHit>& hits) {
    const GnomonQueryOptions options = this_thread();
    hits.resize(rays.size());
    require(gnomon_intersect_n(scene, rays.data(), rays.size(), hits.data(), &options));
}

void LampRays::add(const SurfaceHit& hit, const LampSample& sample, const Rgb& weight, std::uint32_t pixel) {
    const auto ray = sample.end ? ray_to(hit, hit.side, *sample.end) : ray_leaving(hit, hit.side, sample.direction);
    if (!ray) return;
    const bool is_triangle = sample.geometry_id != GNOMON_INVALID_ID;
    (is_triangle ? to_triangles_ : to_others_).push_back(*ray);
    (is_triangle ? from_triangles_ : from_others_)
        .push_back({weight * sample.light, pixel, sample.geometry_id, sample.primitive_id});
}

std::size_t LampRays::trace(const GnomonScene* scene, std::span<Rgb> pixels) {
    intersect_all(scene, to_triangles_, hits_);
    for (std::size_t i = 0; i < hits_.size(); ++i) {
        const Arrival& arrival = from_triangles_[i];
        if (hits_[i].geometry_id == arrival.geometry_id && hits_[i].primitive_id == arrival.primitive_id)
            pixels[arrival.pixel] += arrival.light;
    }

    const GnomonQueryOptions options = this_thread();
    occluded_.resize(to_others_.size());
    require(gnomon_occluded_n(scene, to_others_.data(), to_others_.size(), occluded_.data(), &options));
    for (std::size_t i = 0; i < occluded_.size(); ++i)
        if (occluded_[i] == 0) pixels[from_others_[i].pixel] += from_others_[i].light;

    const std::size_t count = to_triangles_.size() + to_others_.size();
    to_triangles_.clear(), to_others_.clear();
    from_triangles_.clear(), from_others_.clear();
    return count;
}

}  // namespace render
