// Hand-made meshes, rays and options that the API suites share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "api/handles.hpp"
#include "gnomon.h"

namespace harness {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct TriangleMesh {
    std::vector<float> positions;        // x y z, three floats a vertex
    std::vector<std::uint32_t> indices;  // three a triangle

    /// Points into this mesh: valid while it is unchanged.
    GnomonTriangles view() const;
};

/// (0, 0, z), (1, 0, z), (0, 1, z): its normal is +z.
TriangleMesh unit_triangle(float z = 0);

/// Two triangles a cell over [0, cell_count]^2 at height z; cell (x, y) has the triangles 2 (y cell_count + x) and the next one.
TriangleMesh flat_grid(std::uint32_t cell_count, float z = 0);

/// From (x, y, 2) straight down over [0, 10].
GnomonRay ray_down(float x, float y);

/// gnomon_last_error() as doctest prints it.
inline std::string last_error() { return gnomon_last_error(); }

GnomonBuildOptions default_build_options();
GnomonQueryOptions threads_query_options(std::uint32_t thread_count);

/// One geometry a mesh, in order. The failure message of the library ends the test.
SceneHandle build_scene(const std::vector<TriangleMesh>& meshes, const GnomonBuildOptions& options = default_build_options());

struct CountedHit {
    GnomonHit hit;
    GnomonRayCounts counts;
};
CountedHit intersect_counted(const SceneHandle& scene, const GnomonRay& ray);

/// What a query answers in all its forms for one ray, with the fields of a miss where it misses.
GnomonHit intersect(const SceneHandle& scene, const GnomonRay& ray);

bool same_bits(const GnomonHit& a, const GnomonHit& b);

struct Named {
    std::string name;
    std::uint32_t value;
};
// What this version builds.
extern const std::vector<Named> kStructures;
extern const std::vector<Named> kQualities;
extern const std::vector<Named> kPrecisions;
extern const std::vector<Named> kIsas;

/// Build options for each structure, the wide BVH compact too, quality, precision and ISA cap, with a name for the failure
/// message.
struct Configuration {
    std::string name;
    GnomonBuildOptions options;
};
std::vector<Configuration> all_configurations();

}  // namespace harness
