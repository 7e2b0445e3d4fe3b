// One interface in front of every engine, so that each traces the same rays in the same form.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "gnomon.h"
#include "scene/scene.hpp"

namespace harness {

/// How a build went and what it made. A figure that an engine cannot tell is 0.
struct BuildReport {
    std::string engine;     // "gnomon", "embree", "embree_robust"
    std::string structure;  // "brute_force", "bvh", ...
    std::string quality;    // "low", "medium", "high"
    std::string precision;  // gnomon: "fast", "accurate", "exact"; else ""
    std::string isa;        // in use
    bool compact = false;   // gnomon's wide BVH with leaves of unique vertices
    std::uint32_t threads = 0;
    double seconds = 0;
    std::uint64_t triangles = 0, bytes = 0, nodes = 0, references = 0, depth = 0;
    double sah_cost = std::numeric_limits<double>::quiet_NaN();  // NaN where an engine or a structure has none
};

/// fresh: each ray is written field by field right before its call and its answer read right after;
/// prefilled: single calls over an array in the engine's own layout, written before; batch: one call for all.
enum class CallForm { fresh, prefilled, batch };

/// A build that an engine refused or failed at.
struct BuildError : std::runtime_error {
    BuildError(GnomonStatus status, const std::string& what) : std::runtime_error(what), status(status) {}
    GnomonStatus status;
};

/// An answer is a GnomonHit whatever the engine; a miss has t = +inf and GNOMON_INVALID_ID.
class Backend {
public:
    virtual ~Backend() = default;

    const BuildReport& report() const { return report_; }

    /// Sets the rays for the calls that follow; they must outlive them. Not timed.
    virtual void prepare(std::span<const GnomonRay> rays) = 0;

    /// Traces the prepared rays into `hits`, one entry a ray; returns the seconds spent tracing, without laying out records
    /// before or reading them after. `threads` applies to batch alone. An invalid ray is a miss.
    virtual double intersect(CallForm form, std::span<GnomonHit> hits, std::uint32_t threads) = 0;
    virtual double occluded(CallForm form, std::span<std::uint8_t> occluded, std::uint32_t threads) = 0;

    /// What finding each prepared ray's closest hit takes, one entry a ray; all 0 where an engine cannot tell.
    virtual void count(std::span<GnomonRayCounts> counts) { std::ranges::fill(counts, GnomonRayCounts{}); }

    /// gnomon's scene, for its other calls; null of other engines.
    virtual const GnomonScene* scene() const { return nullptr; }

    /// The engine's function behind a form, by its own name; for batch, after a first call.
    virtual std::string call_name(CallForm form, bool occlusion) const = 0;

protected:
    BuildReport report_;
};

/// Throws BuildError with gnomon_last_error() when the build fails.
std::unique_ptr<Backend> make_gnomon(const Scene& scene, const GnomonBuildOptions& options);

/// Null when this program was built without Embree. `quality` is a GNOMON_QUALITY_ value.
/// Rays that Embree cannot take (not finite, t_min < 0, coordinates beyond its limit) are answered as misses.
/// Embree reads the scene's indices in place: the scene must outlive the backend.
std::unique_ptr<Backend> make_embree(const Scene& scene, bool robust, std::uint32_t quality, std::uint32_t threads);

/// Whether Embree can be asked: all coordinates finite and within its limit, and t_min >= 0. False without Embree.
bool embree_takes(const GnomonRay& ray);
bool embree_takes(const Scene& scene);

/// "3.13.5", or "" without Embree.
std::string embree_version();

}  // namespace harness
