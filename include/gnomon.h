/* temporary: replaced by the generated header; same names and layouts */
#ifndef GNOMON_H
#define GNOMON_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
typedef uint32_t GnomonStatus;
#define GNOMON_OK 0u
#define GNOMON_ERROR_INVALID_ARGUMENT 1u
#define GNOMON_ERROR_OUT_OF_MEMORY 2u
#define GNOMON_ERROR_CANCELLED 3u
#define GNOMON_ERROR_UNSUPPORTED 4u
#define GNOMON_ERROR_INTERNAL 5u
#define GNOMON_INVALID_ID 0xFFFFFFFFu
#define GNOMON_INDEX_U16 1u
#define GNOMON_INDEX_U32 2u
#define GNOMON_STRUCTURE_AUTO 0u
#define GNOMON_STRUCTURE_BRUTE_FORCE 1u
#define GNOMON_STRUCTURE_GRID 2u
#define GNOMON_STRUCTURE_OCTREE 3u
#define GNOMON_STRUCTURE_KD_TREE 4u
#define GNOMON_STRUCTURE_BSP_TREE 5u
#define GNOMON_STRUCTURE_BVH 6u
#define GNOMON_STRUCTURE_WIDE_BVH 7u
#define GNOMON_QUALITY_LOW 0u
#define GNOMON_QUALITY_MEDIUM 1u
#define GNOMON_QUALITY_HIGH 2u
#define GNOMON_PRECISION_FAST 0u
#define GNOMON_PRECISION_ACCURATE 1u
#define GNOMON_PRECISION_EXACT 2u
#define GNOMON_ISA_AUTO 0u
#define GNOMON_ISA_SCALAR 1u
#define GNOMON_ISA_SSE42 2u
#define GNOMON_ISA_AVX2 3u
#define GNOMON_ISA_AVX512 4u
#define GNOMON_INVALID_REJECT 0u
#define GNOMON_INVALID_SKIP 1u
typedef struct GnomonRay { float origin[3]; float t_min; float direction[3]; float t_max; } GnomonRay;
typedef struct GnomonHit { float t; float u, v; float normal[3]; uint32_t primitive_id, geometry_id, instance_id; } GnomonHit;
typedef struct GnomonTriangles {
  const float *positions; size_t position_stride; size_t vertex_count;
  const void *indices; uint32_t index_format; size_t index_stride; size_t triangle_count;
} GnomonTriangles;
typedef struct GnomonSceneBuilder GnomonSceneBuilder;
typedef struct GnomonScene GnomonScene;
typedef struct GnomonBuildOptions {
  uint32_t struct_size; uint32_t structure, quality, precision, isa, thread_count, invalid_triangles;
  uint64_t memory_limit_bytes; bool (*progress)(void *user, double done); void *progress_user;
} GnomonBuildOptions;
typedef struct GnomonQueryOptions { uint32_t struct_size; uint32_t thread_count; } GnomonQueryOptions;
typedef struct GnomonSceneStats {
  uint64_t triangle_count, node_count, leaf_count, reference_count, skipped_count;
  uint32_t depth, structure, precision, isa;
  uint64_t bytes, node_bytes, leaf_bytes, peak_build_bytes; double build_seconds, sah_cost;
} GnomonSceneStats;
#ifdef __cplusplus
extern "C" {
#endif
void gnomon_build_options_init(GnomonBuildOptions *);
void gnomon_query_options_init(GnomonQueryOptions *);
GnomonSceneBuilder *gnomon_scene_builder_new(void);
GnomonStatus gnomon_scene_builder_add_triangles(GnomonSceneBuilder *, const GnomonTriangles *, uint32_t *geometry_id_out);
GnomonStatus gnomon_scene_build(const GnomonSceneBuilder *, const GnomonBuildOptions *, GnomonScene **scene_out);
void gnomon_scene_builder_free(GnomonSceneBuilder *);
void gnomon_scene_free(GnomonScene *);
bool gnomon_intersect(const GnomonScene *, const GnomonRay *, GnomonHit *hit_out);
bool gnomon_occluded(const GnomonScene *, const GnomonRay *);
GnomonStatus gnomon_intersect_n(const GnomonScene *, const GnomonRay *rays, size_t count, GnomonHit *hits_out, const GnomonQueryOptions *);
GnomonStatus gnomon_occluded_n(const GnomonScene *, const GnomonRay *rays, size_t count, uint8_t *occluded_out, const GnomonQueryOptions *);
GnomonStatus gnomon_scene_bounds(const GnomonScene *, float lower_out[3], float upper_out[3]);
GnomonStatus gnomon_scene_stats(const GnomonScene *, size_t stats_bytes, GnomonSceneStats *stats_out);
const char *gnomon_last_error(void);
const char *gnomon_status_name(uint32_t);
uint32_t gnomon_version(void);
const char *gnomon_version_string(void);
#ifdef __cplusplus
}
#endif
#endif
