// The rays of one bounce that ask whether lamps are seen.
#pragma once

#include <span>
#include <vector>

#include "render/lamps.hpp"
#include "render/surface_hit.hpp"

namespace render {

class LampRays {
public:
    /// `weight`: the share of the light of `sample` that reaches the pixel if nothing is in the way.
    void add(const SurfaceHit& hit, const LampSample& sample, const Rgb& weight, std::uint32_t pixel);

    /// Adds to the pixels what was seen, and forgets all rays. Returns how many there were. A lamp that is a triangle is seen
    /// where it is the first that its ray hits, so that no distance has to be compared.
    std::size_t trace(const GnomonScene* scene, std::span<Rgb> pixels);

private:
    struct Arrival {
        Rgb light;
        std::uint32_t pixel;
        std::uint32_t geometry_id, primitive_id;  // of the triangle
    };
    std::vector<GnomonRay> to_triangles_, to_others_;
    std::vector<Arrival> from_triangles_, from_others_;
    std::vector<GnomonHit> hits_;
    std::vector<std::uint8_t> occluded_;
};

/// A batch on the calling thread alone.
void intersect_all(const GnomonScene* scene, std::span<const GnomonRay> rays, std::vector<GnomonHit>& hits);

}  // namespace render
