// One interface in front of every engine, so that each traces the same rays in the same form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
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
    std::uint32_t threads = 0;
    double seconds = 0;
    std::uint64_t triangles = 0, bytes = 0, nodes = 0, references = 0, depth = 0;
};

/// fresh: each ray is written field by field right before its call; prefilled: single calls over an array in the engine's own layout, written by prepare(); batch: one call for all.
enum class CallForm { fresh, prefilled, batch };

class Backend {
public:
    virtual ~Backend() = default;

    const BuildReport& report() const { return report_; }

    /// Copies the rays into the engine's own layout, for CallForm::prefilled. Not timed. The rays must outlive the calls.
    virtual void prepare(std::span<const GnomonRay> rays) = 0;

    /// Traces the prepared rays; hits has one entry a ray. `threads` applies to batch alone. An invalid ray is a miss (Embree never sees it).
    virtual void intersect(CallForm form, std::span<GnomonHit> hits, std::uint32_t threads) = 0;
    virtual void occluded(CallForm form, std::span<std::uint8_t> occluded, std::uint32_t threads) = 0;

protected:
    BuildReport report_;
};

/// Throws std::runtime_error with gnomon_last_error() when the build fails.
std::unique_ptr<Backend> make_gnomon(const Scene& scene, const GnomonBuildOptions& options);

/// Null when this program was built without Embree. `quality` is a GNOMON_QUALITY_ value.
std::unique_ptr<Backend> make_embree(const Scene& scene, bool robust, std::uint32_t quality, std::uint32_t threads);

/// "3.13.5", or "" without Embree.
std::string embree_version();

}  // namespace harness
