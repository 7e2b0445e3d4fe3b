// The layouts that the header promises, asserted on the C side; the library asserts the same on its own.
#include <stddef.h>

#include "gnomon.h"

#define ASSERT_SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), "size of " #type)
#define ASSERT_OFFSET(type, field, bytes) _Static_assert(offsetof(type, field) == (bytes), "offset of " #type "." #field)

ASSERT_SIZE(GnomonStatus, 4);

ASSERT_SIZE(GnomonRay, 32);
ASSERT_OFFSET(GnomonRay, origin, 0);
ASSERT_OFFSET(GnomonRay, t_min, 12);
ASSERT_OFFSET(GnomonRay, direction, 16);
ASSERT_OFFSET(GnomonRay, t_max, 28);

ASSERT_SIZE(GnomonHit, 36);
ASSERT_OFFSET(GnomonHit, t, 0);
ASSERT_OFFSET(GnomonHit, u, 4);
ASSERT_OFFSET(GnomonHit, v, 8);
ASSERT_OFFSET(GnomonHit, normal, 12);
ASSERT_OFFSET(GnomonHit, primitive_id, 24);
ASSERT_OFFSET(GnomonHit, geometry_id, 28);
ASSERT_OFFSET(GnomonHit, instance_id, 32);

ASSERT_SIZE(GnomonSurfacePoint, 80);
ASSERT_OFFSET(GnomonSurfacePoint, position, 0);
ASSERT_OFFSET(GnomonSurfacePoint, error, 12);
ASSERT_OFFSET(GnomonSurfacePoint, normal, 24);
ASSERT_OFFSET(GnomonSurfacePoint, surface, 36);
ASSERT_OFFSET(GnomonSurfacePoint, precision, 40);
ASSERT_OFFSET(GnomonSurfacePoint, shape, 44);

ASSERT_SIZE(GnomonRayCounts, 12);
ASSERT_OFFSET(GnomonRayCounts, nodes_visited, 0);
ASSERT_OFFSET(GnomonRayCounts, cells_stepped, 4);
ASSERT_OFFSET(GnomonRayCounts, primitives_tested, 8);

ASSERT_SIZE(GnomonTriangles, 56);
ASSERT_OFFSET(GnomonTriangles, positions, 0);
ASSERT_OFFSET(GnomonTriangles, position_stride, 8);
ASSERT_OFFSET(GnomonTriangles, vertex_count, 16);
ASSERT_OFFSET(GnomonTriangles, indices, 24);
ASSERT_OFFSET(GnomonTriangles, index_format, 32);
ASSERT_OFFSET(GnomonTriangles, index_stride, 40);
ASSERT_OFFSET(GnomonTriangles, triangle_count, 48);

ASSERT_SIZE(GnomonBuildOptions, 64);
ASSERT_OFFSET(GnomonBuildOptions, struct_size, 0);
ASSERT_OFFSET(GnomonBuildOptions, structure, 4);
ASSERT_OFFSET(GnomonBuildOptions, quality, 8);
ASSERT_OFFSET(GnomonBuildOptions, precision, 12);
ASSERT_OFFSET(GnomonBuildOptions, isa, 16);
ASSERT_OFFSET(GnomonBuildOptions, thread_count, 20);
ASSERT_OFFSET(GnomonBuildOptions, invalid_triangles, 24);
ASSERT_OFFSET(GnomonBuildOptions, memory_limit_bytes, 32);
ASSERT_OFFSET(GnomonBuildOptions, progress, 40);
ASSERT_OFFSET(GnomonBuildOptions, progress_user, 48);
ASSERT_OFFSET(GnomonBuildOptions, compact, 56);
ASSERT_OFFSET(GnomonBuildOptions, grid_cells_per_triangle, 60);

ASSERT_SIZE(GnomonQueryOptions, 8);
ASSERT_OFFSET(GnomonQueryOptions, struct_size, 0);
ASSERT_OFFSET(GnomonQueryOptions, thread_count, 4);

ASSERT_SIZE(GnomonSpheres, 40);
ASSERT_OFFSET(GnomonSpheres, centres, 0);
ASSERT_OFFSET(GnomonSpheres, centre_stride, 8);
ASSERT_OFFSET(GnomonSpheres, radii, 16);
ASSERT_OFFSET(GnomonSpheres, radius_stride, 24);
ASSERT_OFFSET(GnomonSpheres, sphere_count, 32);

ASSERT_SIZE(GnomonSceneStats, 112);
ASSERT_OFFSET(GnomonSceneStats, triangle_count, 0);
ASSERT_OFFSET(GnomonSceneStats, node_count, 8);
ASSERT_OFFSET(GnomonSceneStats, leaf_count, 16);
ASSERT_OFFSET(GnomonSceneStats, reference_count, 24);
ASSERT_OFFSET(GnomonSceneStats, skipped_count, 32);
ASSERT_OFFSET(GnomonSceneStats, depth, 40);
ASSERT_OFFSET(GnomonSceneStats, structure, 44);
ASSERT_OFFSET(GnomonSceneStats, precision, 48);
ASSERT_OFFSET(GnomonSceneStats, isa, 52);
ASSERT_OFFSET(GnomonSceneStats, bytes, 56);
ASSERT_OFFSET(GnomonSceneStats, node_bytes, 64);
ASSERT_OFFSET(GnomonSceneStats, leaf_bytes, 72);
ASSERT_OFFSET(GnomonSceneStats, peak_build_bytes, 80);
ASSERT_OFFSET(GnomonSceneStats, build_seconds, 88);
ASSERT_OFFSET(GnomonSceneStats, sah_cost, 96);
ASSERT_OFFSET(GnomonSceneStats, sphere_count, 104);

ASSERT_SIZE(GnomonIrradianceOptions, 24);
ASSERT_OFFSET(GnomonIrradianceOptions, struct_size, 0);
ASSERT_OFFSET(GnomonIrradianceOptions, thread_count, 4);
ASSERT_OFFSET(GnomonIrradianceOptions, sample_count, 8);
ASSERT_OFFSET(GnomonIrradianceOptions, seed, 16);

ASSERT_SIZE(GnomonDirectionSample, 16);
ASSERT_OFFSET(GnomonDirectionSample, direction, 0);
ASSERT_OFFSET(GnomonDirectionSample, density_per_sr, 12);

ASSERT_SIZE(GnomonPointSource, 20);
ASSERT_OFFSET(GnomonPointSource, position, 0);
ASSERT_OFFSET(GnomonPointSource, intensity_cd, 12);
ASSERT_OFFSET(GnomonPointSource, range_m, 16);

ASSERT_SIZE(GnomonSpotSource, 40);
ASSERT_OFFSET(GnomonSpotSource, position, 0);
ASSERT_OFFSET(GnomonSpotSource, intensity_cd, 12);
ASSERT_OFFSET(GnomonSpotSource, direction, 16);
ASSERT_OFFSET(GnomonSpotSource, range_m, 28);
ASSERT_OFFSET(GnomonSpotSource, inner_cone_rad, 32);
ASSERT_OFFSET(GnomonSpotSource, outer_cone_rad, 36);

ASSERT_SIZE(GnomonDirectionalSource, 16);
ASSERT_OFFSET(GnomonDirectionalSource, direction, 0);
ASSERT_OFFSET(GnomonDirectionalSource, illuminance_lx, 12);

ASSERT_SIZE(GnomonSphereSource, 20);
ASSERT_OFFSET(GnomonSphereSource, centre, 0);
ASSERT_OFFSET(GnomonSphereSource, radius, 12);
ASSERT_OFFSET(GnomonSphereSource, luminance_nt, 16);

ASSERT_SIZE(GnomonAreaSource, 64);
ASSERT_OFFSET(GnomonAreaSource, triangles, 0);
ASSERT_OFFSET(GnomonAreaSource, luminance_nt, 56);
ASSERT_OFFSET(GnomonAreaSource, is_two_sided, 60);

ASSERT_SIZE(GnomonSources, 88);
ASSERT_OFFSET(GnomonSources, struct_size, 0);
ASSERT_OFFSET(GnomonSources, points, 8);
ASSERT_OFFSET(GnomonSources, point_count, 16);
ASSERT_OFFSET(GnomonSources, spots, 24);
ASSERT_OFFSET(GnomonSources, spot_count, 32);
ASSERT_OFFSET(GnomonSources, directionals, 40);
ASSERT_OFFSET(GnomonSources, directional_count, 48);
ASSERT_OFFSET(GnomonSources, spheres, 56);
ASSERT_OFFSET(GnomonSources, sphere_count, 64);
ASSERT_OFFSET(GnomonSources, areas, 72);
ASSERT_OFFSET(GnomonSources, area_count, 80);

ASSERT_SIZE(GnomonIrradiance, 24);
ASSERT_OFFSET(GnomonIrradiance, illuminance_lx, 0);
ASSERT_OFFSET(GnomonIrradiance, standard_error_lx, 8);
ASSERT_OFFSET(GnomonIrradiance, ray_count, 16);
