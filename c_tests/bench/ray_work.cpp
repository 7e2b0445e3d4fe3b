#include "bench/ray_work.hpp"

namespace harness {
namespace {

double hit_share(Backend& backend, const RaySet& set) {
    std::size_t count = 0;
    backend.prepare(set.rays);
    if (set.occlusion) {
        std::vector<std::uint8_t> occluded(set.rays.size());
        backend.occluded(CallForm::prefilled, occluded, 1);
        for (const std::uint8_t hit : occluded) count += hit;
    } else {
        std::vector<GnomonHit> hits(set.rays.size());
        backend.intersect(CallForm::prefilled, hits, 1);
        for (const GnomonHit& hit : hits) count += hit.geometry_id != GNOMON_INVALID_ID;
    }
    return static_cast<double>(count) / static_cast<double>(set.rays.size());
}

}  // namespace

RayWork mean_work(Backend& backend, const RaySet& set) {
    std::vector<GnomonRayCounts> counts(set.rays.size());
    backend.prepare(set.rays);
    backend.count(counts);
    RayWork sum;
    for (const GnomonRayCounts& count : counts) {
        sum.nodes += count.nodes_visited;
        sum.cells += count.cells_stepped;
        sum.primitives += count.primitives_tested;
    }
    const double ray_count = static_cast<double>(counts.size());
    return {sum.nodes / ray_count, sum.cells / ray_count, sum.primitives / ray_count};
}

RaySetInfo ray_set_info(const std::string& view, const RaySet& set, Backend& backend) {
    const RayWork work = mean_work(backend, set);
    return {view, set.kind, set.rays.size(), 0, hit_share(backend, set), work.nodes, work.primitives};
}

}  // namespace harness
