// gnomon: ray queries against a scene of triangles and spheres, with the same answer from every structure.
//
// Conventions
//   Coordinates are floats in any one unit and handedness. A ray is origin + t * direction for t in the closed
//   interval [t_min, t_max]; t counts in lengths of the direction. A triangle is closed, and both its sides are
//   hit. Of two hits with the same t the one with the lower (geometry_id, primitive_id) wins, in every structure
//   and call. A triangle of zero area is valid and never hit.
//
// A scene in five calls
//   GnomonSceneBuilder *builder = gnomon_scene_builder_new();
//   gnomon_scene_builder_add_triangles(builder, &triangles, &geometry_id);
//   gnomon_scene_build(builder, NULL, &scene);
//   gnomon_scene_builder_free(builder);
//   if (gnomon_intersect(scene, &ray, &hit)) ...
//
// A path tracer's bounce, without an epsilon
//   if (gnomon_intersect(scene, &ray, &hit) && gnomon_surface_point(scene, &ray, &hit, &point) == GNOMON_OK) {
//       sample_direction(point.normal, next.direction);
//       gnomon_offset_origin(&point, next.direction, next.origin);  // off the surface, on the side of the direction
//       next.t_min = 0, next.t_max = INFINITY;
//   }
//
// Light
//   Sources, solid angles and sampling take lengths for metres, as glTF has them, and say the unit in the name: lm, cd, lx, nt
//   (cd/m^2), W, sr, rad. gnomon_irradiance adds up what arrives at a point, with the scene's shadows.
//
// Errors
//   Functions that can fail return a GnomonStatus; gnomon_last_error() gives the calling thread's last failure as
//   one sentence. Outputs are written only on success. Numbers for structures, precisions and the like enter as
//   uint32_t: an unknown one is GNOMON_ERROR_INVALID_ARGUMENT. No panic of the library's own leaves it.
//
// Threads
//   A builder belongs to one thread at a time. A scene is immutable: any number of threads may query it.
//
// Accuracy (u = 2^-24)
//   No ray slips through a shared edge or vertex of a mesh, in any precision.
//   FAST and ACCURATE decide in float: where a ray passes an edge at less than the rounding of its coordinates, a
//   few u of the distance, they may take the neighbour across it. ACCURATE gives t within 0.51 ulp, and u and v
//   within 0.52 u, of the exact values. EXACT decides as if nothing was rounded. Coordinates may be as large as 1e38,
//   in EXACT 3.4e38, and as small as they come. Gradual underflow is expected to be on, as it is unless a host sets
//   FTZ or DAZ: these make zeros of denormal numbers, in EXACT too. The library never changes the floating-point
//   environment.

#ifndef GNOMON_H
#define GNOMON_H

// Generated from src/ffi by cbindgen: `cargo test --test header` compares it, UPDATE_HEADER=1 renews it.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The id of what is not there: a miss's geometry and primitive, the instance where none is involved.
#define GNOMON_INVALID_ID 4294967295u

// `indices` are `uint16_t`.
#define GNOMON_INDEX_U16 1u

// `indices` are `uint32_t`.
#define GNOMON_INDEX_U32 2u

// A `GnomonSurfacePoint` of a triangle.
#define GNOMON_SURFACE_TRIANGLE 0u

// A `GnomonSurfacePoint` of a sphere.
#define GNOMON_SURFACE_SPHERE 1u

// All went well.
#define GNOMON_OK 0u

// An argument can't be used: a null pointer, an unknown number, an index out of range, a coordinate that is not
// finite. The caller can mend it.
#define GNOMON_ERROR_INVALID_ARGUMENT 1u

// Memory ran out, or `memory_limit_bytes` would have been passed. Nothing was changed.
#define GNOMON_ERROR_OUT_OF_MEMORY 2u

// The progress callback asked for an end.
#define GNOMON_ERROR_CANCELLED 3u

// This version has no such structure, quality or precision. None is missing at present.
#define GNOMON_ERROR_UNSUPPORTED 4u

// A bug in gnomon, or a machine that could not start threads. Nothing was changed.
#define GNOMON_ERROR_INTERNAL 5u

// The best there is for the scene: brute force for a handful of triangles, else the wide BVH.
#define GNOMON_STRUCTURE_AUTO 0u

// Every triangle is asked: for a handful, and as a reference.
#define GNOMON_STRUCTURE_BRUTE_FORCE 1u

// Uniform grid: for triangles of one size, evenly spread.
#define GNOMON_STRUCTURE_GRID 2u

// Octree: for scenes that are empty here and crowded there.
#define GNOMON_STRUCTURE_OCTREE 3u

// kd-tree: planes across the axes, each triangle in the leaves that it reaches into. At most 2^28 - 1 triangles.
#define GNOMON_STRUCTURE_KD_TREE 4u

// BSP tree: planes of 13 fixed directions and of the triangles themselves. Slow to build. At most 2^28 - 1 triangles.
#define GNOMON_STRUCTURE_BSP_TREE 5u

// Binary bounding volume hierarchy.
#define GNOMON_STRUCTURE_BVH 6u

// Bounding volume hierarchy with 8 children a node, tested at once by SSE4.2 or AVX2 where the CPU has it: the fastest
// and smallest here. At most 2^28 triangles.
#define GNOMON_STRUCTURE_WIDE_BVH 7u

// Fastest build. GRID: 2 cells a triangle. OCTREE: leaves of 16 triangles, where there are as many. KD_TREE: split at the
// median, the axes in turn. BSP_TREE: the fixed directions alone. BVH: split at the median of the longest axis. WIDE_BVH:
// split in Morton order (Lauterbach et al. 2009).
#define GNOMON_QUALITY_LOW 0u

// Good for both. GRID: 6 cells a triangle. OCTREE: leaves of 8. KD_TREE: surface area heuristic over clipped triangles
// (Wald and Havran 2006). BSP_TREE: the same over all its planes (Ize, Wald, Parker 2008). BVH and WIDE_BVH: binned surface
// area heuristic (Wald 2007).
#define GNOMON_QUALITY_MEDIUM 1u

// Best queries. GRID: 12 cells a triangle. OCTREE: leaves of 6. KD_TREE and BSP_TREE: as MEDIUM. BVH and WIDE_BVH: as
// MEDIUM, with spatial splits where they pay (Stich, Friedrich, Dietrich 2009), then improved by reinsertion (Meister and
// Bittner 2018).
#define GNOMON_QUALITY_HIGH 2u

// Decided in float, watertight; t, u and v come from what decided. For previews.
#define GNOMON_PRECISION_FAST 0u

// Decided as FAST; t within 0.51 ulp, u and v within 0.52 * 2^-24 of the exact values. For rendering; the default.
#define GNOMON_PRECISION_ACCURATE 1u

// Decided as if nothing was ever rounded, for every finite ray and triangle: which triangles are hit, and which first. t is the
// float nearest to the exact value, u and v are as with ACCURATE; the interval is that of the rounded t, so that a ray that ends
// at its hit's t hits again. For acoustics, particle transport and CAD: 4 to 6 % slower than ACCURATE. Hits at the same exact t, and
// those of a sphere at the same rounded one, are told apart by their ids.
#define GNOMON_PRECISION_EXACT 2u

// The best instruction set that the CPU has.
#define GNOMON_ISA_AUTO 0u

// No vector instructions beyond the compiler's baseline.
#define GNOMON_ISA_SCALAR 1u

// At most SSE4.2.
#define GNOMON_ISA_SSE42 2u

// At most AVX2 and FMA.
#define GNOMON_ISA_AVX2 3u

// At most AVX-512 F, VL, DQ and BW.
#define GNOMON_ISA_AVX512 4u

// A triangle with a coordinate that is not finite fails the build, which names the first one. The default.
#define GNOMON_INVALID_REJECT 0u

// Such a triangle is left out and counted in the stats; the others keep their ids.
#define GNOMON_INVALID_SKIP 1u

// K_m, the luminous efficacy of light at 555 nm, where the eye is most sensitive [lm/W]. Source: "Principles governing photometry",
// BIPM monograph, 2nd edition 2019.
#define GNOMON_MAX_LUMINOUS_EFFICACY_LM_PER_W 683.0

// An immutable scene; any number of threads may query it at a time.
typedef struct GnomonScene GnomonScene;

// Collects meshes and spheres; belongs to one thread at a time.
typedef struct GnomonSceneBuilder GnomonSceneBuilder;

// Told the share of a build that is done, in [0, 1] and never falling, and `progress_user`. Returning false cancels
// the build.
//
// Called on the thread that called `gnomon_scene_build`, at 0, about every 10 ms, and at 1. It may throw a C++
// exception: the build is cancelled, and the exception passes through `gnomon_scene_build`.
typedef bool (*GnomonProgress)(void *user, double done);

// How to build a scene. Fill it with `gnomon_build_options_init`, then change what you like.
typedef struct GnomonBuildOptions {
    // `sizeof(GnomonBuildOptions)`, so that a program compiled against an older header keeps working.
    uint32_t struct_size;
    // `GNOMON_STRUCTURE_*`; by default `_AUTO`.
    uint32_t structure;
    // `GNOMON_QUALITY_*`; by default `_MEDIUM`.
    uint32_t quality;
    // `GNOMON_PRECISION_*`; by default `_ACCURATE`.
    uint32_t precision;
    // `GNOMON_ISA_*`, the most that queries may use, so that one machine can test every path; by default `_AUTO`.
    // The answers do not depend on it.
    uint32_t isa;
    // Threads of the build; 0, the default: as many as the machine has. The scene does not depend on it.
    uint32_t thread_count;
    // `GNOMON_INVALID_*`; by default `_REJECT`.
    uint32_t invalid_triangles;
    // What the build may hold at a time, the builder's copy of the meshes not counted; a build that would pass it
    // fails with `GNOMON_ERROR_OUT_OF_MEMORY` before it allocates. 0, the default: no limit.
    uint64_t memory_limit_bytes;
    // NULL, the default: nobody is told.
    GnomonProgress progress;
    // Passed on to `progress`.
    void *progress_user;
    // 1: a WIDE_BVH stores each vertex of a leaf once, which takes a third less memory of a mesh and makes queries
    // slower, by up to a fifth; at most 44 million triangles. The answers are the same. 0, the default: it does
    // not. No other structure is changed by it.
    uint32_t compact;
    // How many cells a GRID has for each triangle, roughly; fewer where its lists would take too much memory. 0, the
    // default: 2, 6 or 12 by quality. More make a difference where rays pass much that is empty; 27 is a number often
    // taught. No other structure is changed by it.
    float grid_cells_per_triangle;
} GnomonBuildOptions;

// How to answer a batch. Fill it with `gnomon_query_options_init`, then change what you like.
typedef struct GnomonQueryOptions {
    // `sizeof(GnomonQueryOptions)`, so that a program compiled against an older header keeps working.
    uint32_t struct_size;
    // The most threads to use; 0, the default: as many as the machine has; 1: the calling thread alone.
    uint32_t thread_count;
} GnomonQueryOptions;

// How hard `gnomon_irradiance` tries. Fill it with `gnomon_irradiance_options_init`, then change what you like.
typedef struct GnomonIrradianceOptions {
    // `sizeof(GnomonIrradianceOptions)`, so that a program compiled against an older header keeps working.
    uint32_t struct_size;
    // As in `GnomonQueryOptions`. The answer does not depend on it.
    uint32_t thread_count;
    // Rays towards spheres and triangles, all together; by default 4096.
    uint64_t sample_count;
    // The same one gives the same answer; by default 0.
    uint64_t seed;
} GnomonIrradianceOptions;

// How a call ended: one of the `GNOMON_OK` and `GNOMON_ERROR_*` numbers. They never change their meaning; a later
// version may add some.
typedef uint32_t GnomonStatus;

// A triangle mesh in the caller's memory, which `gnomon_scene_builder_add_triangles` copies.
//
// No alignment is asked for, and nothing is read beyond the last byte of the last vertex and of the last index.
typedef struct GnomonTriangles {
    // Three floats (x, y, z) at the start of each stride; may be null without vertices.
    const float *positions;
    // Bytes from one vertex to the next, at least 12; 0 means 12.
    size_t position_stride;
    // How many vertices there are.
    size_t vertex_count;
    // Three indices at the start of each stride, each below `vertex_count`. NULL: the vertices are taken three by
    // three.
    const void *indices;
    // `GNOMON_INDEX_U16` or `GNOMON_INDEX_U32`; not looked at without `indices`.
    uint32_t index_format;
    // Bytes from one triangle to the next, at least three indices; 0 means just three indices.
    size_t index_stride;
    // How many triangles there are; their place in the order is their `primitive_id`. May be 0.
    size_t triangle_count;
} GnomonTriangles;

// Spheres in the caller's memory, which `gnomon_scene_builder_add_spheres` copies.
//
// No alignment is asked for, and nothing is read beyond the last byte of the last centre and of the last radius. For
// spheres of four floats each (x, y, z, radius) let `centres` point to the first x, `radii` to the first radius, and both
// strides be 16.
typedef struct GnomonSpheres {
    // Three floats (x, y, z) at the start of each stride; may be null without spheres.
    const float *centres;
    // Bytes from one centre to the next, at least 12; 0 means 12.
    size_t centre_stride;
    // A float at the start of each stride, not below 0; a sphere of radius 0 is never hit. May be null without spheres.
    const float *radii;
    // Bytes from one radius to the next, at least 4; 0 means 4.
    size_t radius_stride;
    // How many there are; their place in the order is their `primitive_id`. May be 0.
    size_t sphere_count;
} GnomonSpheres;

// What a scene is made of. Later versions add fields at the end.
typedef struct GnomonSceneStats {
    // Triangles that were added, without the skipped ones.
    uint64_t triangle_count;
    // Nodes, leaves among them; the cells of a grid; 0 for brute force.
    uint64_t node_count;
    // Nodes without children; the cells of a grid.
    uint64_t leaf_count;
    // Triangles and spheres stored in leaves: not those of zero area or radius, which nothing hits, nor copies (equal to the
    // bit) that a BVH cannot tell apart. Where leaves divide space, one counts in each that it overlaps.
    uint64_t reference_count;
    // Triangles and spheres left out by `GNOMON_INVALID_SKIP`.
    uint64_t skipped_count;
    // Nodes on the longest way from the root to a leaf, both counted; 0 without nodes.
    uint32_t depth;
    // The `GNOMON_STRUCTURE_*` that was built.
    uint32_t structure;
    // The `GNOMON_PRECISION_*` in use.
    uint32_t precision;
    // The `GNOMON_ISA_*` in use.
    uint32_t isa;
    // Memory that the scene holds.
    uint64_t bytes;
    // Of these, for nodes.
    uint64_t node_bytes;
    // Of these, for triangles and spheres.
    uint64_t leaf_bytes;
    // The most that the build held at a time, the scene among it, the builder's copy of the meshes not.
    uint64_t peak_build_bytes;
    // Wall-clock time of the build.
    double build_seconds;
    // Expected cost of a random ray that meets the scene's box, in triangle tests (MacDonald and Booth 1990,
    // "Heuristics for ray tracing using space subdivision"); NaN where it has no meaning. Triangles and spheres have a
    // structure each: the sum of both.
    double sah_cost;
    // Spheres that were added, without the skipped ones.
    uint64_t sphere_count;
} GnomonSceneStats;

// `origin + t * direction` for `t` in the closed interval `[t_min, t_max]`. 32 bytes.
//
// A ray with a NaN, an infinite origin or direction, a zero direction, or `t_min > t_max` misses everything. `t_max`
// may be `INFINITY`, `t_min` may be negative.
typedef struct GnomonRay {
    // Where `t` is 0, in the scene's units.
    float origin[3];
    // Hits with `t_min <= t <= t_max` count.
    float t_min;
    // Need not be of unit length: `t` counts in its lengths.
    float direction[3];
    // See `t_min`.
    float t_max;
} GnomonRay;

// What a ray hits first. 36 bytes.
//
// Of two hits with the same `t` the one with the lower `(geometry_id, primitive_id)` wins.
typedef struct GnomonHit {
    // In lengths of the ray's direction; `INFINITY` for a miss.
    float t;
    // The hit point is `(1 - u - v) * p0 + u * p1 + v * p2` of the triangle's vertices; 0 for a sphere and for a miss.
    float u;
    // See `u`.
    float v;
    // `(p1 - p0) x (p2 - p0)`, not normalised (Embree's `Ng`), each component rounded once from double; of a sphere from
    // the centre to the hit, as long as the radius; 0 for a miss.
    float normal[3];
    // The triangle's or sphere's index within its geometry; `GNOMON_INVALID_ID` for a miss.
    uint32_t primitive_id;
    // What `gnomon_scene_builder_add_triangles` or `_add_spheres` gave; `GNOMON_INVALID_ID` for a miss.
    uint32_t geometry_id;
    // `GNOMON_INVALID_ID` where no instance is involved.
    uint32_t instance_id;
} GnomonHit;

// What a query did to find its answer. 12 bytes.
//
// The same in every run, so that structures can be compared where clocks are noisy. Instruction sets round the bounds
// of boxes and hits differently, so now and then a ray takes a step more or less. A number that does not fit stays
// at `UINT32_MAX`.
typedef struct GnomonRayCounts {
    // Nodes whose children's boxes were tested, in one step or one by one; a leaf is none.
    uint32_t nodes_visited;
    // Cells that the ray was led through; 0 in structures without cells.
    uint32_t cells_stepped;
    // Triangles and spheres of the leaves that were tested, each for itself or eight at once; without a structure, all.
    uint32_t primitives_tested;
} GnomonRayCounts;

// The point where a ray hit a surface. 80 bytes.
//
// It stands for the point where the exact ray meets the surface. Where FAST or ACCURATE took a triangle that the exact ray
// passes by less than their rounding, it stands for a point of that triangle as near to the ray.
typedef struct GnomonSurfacePoint {
    // The point, computed in double and rounded once.
    float position[3];
    // The exact point is no further from `position` along each axis: proven, and seldom above `2^-24 * |position|`. Not
    // below 0.
    float error[3];
    // Of unit length, to the side that `GnomonHit.normal` points to. Of a triangle each component is within `0.51 * 2^-24`;
    // of a sphere it is outward and besides off by no more than `error` is in radii.
    float normal[3];
    // `GNOMON_SURFACE_*`.
    uint32_t surface;
    // The scene's `GNOMON_PRECISION_*`.
    uint32_t precision;
    // What `gnomon_offset_origin` needs of the surface: a triangle's vertices, x, y and z of each; a sphere's centre and
    // radius, then zeros.
    float shape[9];
} GnomonSurfacePoint;

// A direction, and how densely its neighbourhood is sampled. 16 bytes.
//
// Made from two independent numbers u and v, uniform in [0, 1]; other numbers than those are an error. Computed in double, each
// component rounded once; the density is that of the direction before.
typedef struct GnomonDirectionSample {
    // Of unit length.
    float direction[3];
    // In 1/sr: it integrates to 1 over all directions. 0: there is nothing to sample.
    float density_per_sr;
} GnomonDirectionSample;

// Shines from a point evenly in all directions: glTF's point light. 20 bytes.
typedef struct GnomonPointSource {
    // Where it is, in metres, as all lengths here.
    float position[3];
    // Not below 0.
    float intensity_cd;
    // What arrives is less the nearer that is, and nothing beyond: `gnomon_range_attenuation`. 0 and `INFINITY`: no range.
    float range_m;
} GnomonPointSource;

// Shines from a point into a cone: glTF's spot light. 40 bytes.
typedef struct GnomonSpotSource {
    // Where it is.
    float position[3];
    // On the axis; not below 0.
    float intensity_cd;
    // The axis, away from the source, of any length.
    float direction[3];
    // As `GnomonPointSource.range_m`.
    float range_m;
    // From the axis up to here the intensity is that on the axis; `0 <= inner < outer`.
    float inner_cone_rad;
    // From here on there is none; at most pi / 2. In between: `gnomon_spot_attenuation`.
    float outer_cone_rad;
} GnomonSpotSource;

// Shines from so far away that its light is the same everywhere: glTF's directional light. 16 bytes.
typedef struct GnomonDirectionalSource {
    // In which the light travels, of any length.
    float direction[3];
    // On a surface across the direction; not below 0.
    float illuminance_lx;
} GnomonDirectionalSource;

// A sphere that looks equally bright from everywhere outside. 20 bytes.
typedef struct GnomonSphereSource {
    // Where it is.
    float centre[3];
    // Not below 0.
    float radius;
    // Not below 0; in cd/m^2.
    float luminance_nt;
} GnomonSphereSource;

// Triangles that look equally bright from everywhere on their front side, from which their vertices go counter-clockwise: glTF's
// emissive material with KHR_materials_emissive_strength.
typedef struct GnomonAreaSource {
    // In the caller's memory; they need not be, but may be, those of a geometry of the scene.
    struct GnomonTriangles triangles;
    // Not below 0; in cd/m^2.
    float luminance_nt;
    // 1: the back shines as well; 0: it does not.
    uint32_t is_two_sided;
} GnomonAreaSource;

// All sources of light. Zero it, set `struct_size`, then what there is: a kind of which there are none costs nothing.
//
// What arrives is linear in their values: given in W/sr, W/m^2 and W/(m^2 sr) instead, it is in W/m^2.
typedef struct GnomonSources {
    // `sizeof(GnomonSources)`, so that a program compiled against an older header keeps working.
    uint32_t struct_size;
    // May be NULL where there are none, as all of these.
    const struct GnomonPointSource *points;
    // How many.
    size_t point_count;
    // See `points`.
    const struct GnomonSpotSource *spots;
    // How many.
    size_t spot_count;
    // See `points`.
    const struct GnomonDirectionalSource *directionals;
    // How many.
    size_t directional_count;
    // See `points`.
    const struct GnomonSphereSource *spheres;
    // How many.
    size_t sphere_count;
    // See `points`.
    const struct GnomonAreaSource *areas;
    // How many.
    size_t area_count;
} GnomonSources;

// What arrives at a point. 24 bytes.
typedef struct GnomonIrradiance {
    // On a surface there, from all sources.
    double illuminance_lx;
    // Of the part that is sampled: 0 where nothing is, and where all samples agree.
    double standard_error_lx;
    // How many rays were traced.
    uint64_t ray_count;
} GnomonIrradiance;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The last failure of the calling thread as one sentence that names the culprit and its values: which geometry,
// which triangle, which index. "" before the first one; a later success does not clear it.
//
// The text is UTF-8 and ends with a NUL; it belongs to the library and stays valid until the next failing call on
// the same thread, or the thread's end. Any thread may call this.
const char *gnomon_last_error(void);

// The name of a status, for example "GNOMON_ERROR_OUT_OF_MEMORY"; "GNOMON_STATUS_UNKNOWN" for a number without a
// meaning.
//
// The text is static. Any thread may call this.
const char *gnomon_status_name(uint32_t status);

// Fills in the defaults. A null pointer is an error that `gnomon_last_error` tells.
void gnomon_build_options_init(struct GnomonBuildOptions *options_out);

// Fills in the defaults. A null pointer is an error that `gnomon_last_error` tells.
void gnomon_query_options_init(struct GnomonQueryOptions *options_out);

// Fills in the defaults. A null pointer is an error that `gnomon_last_error` tells.
void gnomon_irradiance_options_init(struct GnomonIrradianceOptions *options_out);

// An empty builder, to be freed with `gnomon_scene_builder_free`. NULL if memory ran out.
struct GnomonSceneBuilder *gnomon_scene_builder_new(void);

// Copies a mesh into the builder; the caller's arrays may go afterwards.
//
// `geometry_id_out` gets the mesh's id: 0 for the first, 1 for the second, and so on. It may be NULL. Coordinates
// are not looked at before the build, which decides by `invalid_triangles` about those that are not finite.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, an unknown index format, a stride that is too small,
// counts that no memory can hold, or an index out of range (the message names the geometry, the triangle, the index,
// and how many vertices there are); `GNOMON_ERROR_OUT_OF_MEMORY`. On an error the builder is as it was.
GnomonStatus gnomon_scene_builder_add_triangles(struct GnomonSceneBuilder *builder,
                                                const struct GnomonTriangles *triangles,
                                                uint32_t *geometry_id_out);

// Copies spheres into the builder; the caller's arrays may go afterwards.
//
// `geometry_id_out` gets their id, from the same count as those of meshes; it may be NULL. Spheres are surfaces: a ray
// from inside hits the far side. Hits are decided exactly, in every precision; `t` is within 0.51 ulp; `u` and `v` are 0; the
// normal points from the centre to the hit and is as long as the radius. Centres and radii are not looked at before the
// build, which decides by `invalid_triangles` about those that are not finite, and about radii below 0. A sphere of
// radius 0 is valid and never hit. A scene without spheres pays nothing for them.
//
// Source: Haines, Guenther, Akenine-Moeller 2019, "Precision improvements for ray/sphere intersection", Ray Tracing Gems,
// chapter 7.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a stride that is too small, or a count that no memory can
// hold; `GNOMON_ERROR_OUT_OF_MEMORY`. On an error the builder is as it was.
GnomonStatus gnomon_scene_builder_add_spheres(struct GnomonSceneBuilder *builder,
                                              const struct GnomonSpheres *spheres,
                                              uint32_t *geometry_id_out);

// Frees a builder; scenes built from it stay. NULL is fine.
void gnomon_scene_builder_free(struct GnomonSceneBuilder *builder);

// Builds a scene from all meshes and spheres of a builder; the builder stays as it is and may build again. Without any
// the scene is empty: every ray misses.
//
// `options` may be NULL for the defaults. `scene_out` gets the scene, to be freed with `gnomon_scene_free`; it is
// not touched on an error. Threads: see `thread_count`. Other threads may build other scenes, and query this
// builder's earlier ones, meanwhile.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, an unknown number in the options, or a triangle that
// is not finite (unless it is to be skipped; the message names the geometry, the triangle and the vertex), or such a
// sphere;
// `GNOMON_ERROR_OUT_OF_MEMORY`; `GNOMON_ERROR_CANCELLED`; `GNOMON_ERROR_INTERNAL`.
GnomonStatus gnomon_scene_build(const struct GnomonSceneBuilder *builder,
                                const struct GnomonBuildOptions *options,
                                struct GnomonScene **scene_out);

// Frees a scene. NULL is fine.
void gnomon_scene_free(struct GnomonScene *scene);

// The box of all triangles and spheres that were not skipped, those of zero area among them; a sphere's rounded outward. Without any, lower is `INFINITY`
// and upper `-INFINITY`.
//
// `lower_out` and `upper_out` get three floats each (x, y, z), exact. Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a
// null pointer. Any thread may call this.
GnomonStatus gnomon_scene_bounds(const struct GnomonScene *scene,
                                 float lower_out[3],
                                 float upper_out[3]);

// What a scene is made of and what its build took.
//
// Writes the first `stats_bytes` bytes: pass `sizeof(GnomonSceneStats)`, and a program compiled against an older
// header gets the fields that it knows; bytes beyond those that this library knows become 0. Errors:
// `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer. Any thread may call this.
GnomonStatus gnomon_scene_stats(const struct GnomonScene *scene,
                                size_t stats_bytes,
                                struct GnomonSceneStats *stats_out);

// The closest hit of a ray: true if there is one, and `hit_out` gets it; false for a miss, and `hit_out` says so.
//
// Accuracy: see `GNOMON_PRECISION_*`; the answer is the same on every instruction set and in every structure, and
// `gnomon_occluded` never disagrees. Any number of threads may call this on one scene. A null pointer answers false
// and sets `gnomon_last_error`; `hit_out` then is not touched.
bool gnomon_intersect(const struct GnomonScene *scene,
                      const struct GnomonRay *ray,
                      struct GnomonHit *hit_out);

// As `gnomon_intersect`, with the same answer to the bit, and `counts_out` gets what finding it took: for comparing
// structures and for finding out why rays are slow.
//
// A ray that is not valid takes nothing. Any number of threads may call this on one scene. A null pointer answers false
// and sets `gnomon_last_error`; `hit_out` and `counts_out` then are not touched.
bool gnomon_intersect_counted(const struct GnomonScene *scene,
                              const struct GnomonRay *ray,
                              struct GnomonHit *hit_out,
                              struct GnomonRayCounts *counts_out);

// Whether a ray hits anything at all: for shadows and visibility.
//
// True just where `gnomon_intersect` is, and usually faster. Any number of threads may call this on one scene. A null
// pointer answers false and sets `gnomon_last_error`.
bool gnomon_occluded(const struct GnomonScene *scene,
                     const struct GnomonRay *ray);

// As `gnomon_intersect` for each of `count` rays, with the same answers to the bit, shared out among threads.
//
// `hits_out` gets one hit a ray, in the rays' order; the two arrays must not overlap. `options` may be NULL for the
// defaults. `count` 0 is fine, the arrays then may be NULL.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, an array that is not aligned for floats, or a count
// that no memory can hold; nothing is written then. Any number of threads may call this on one scene.
GnomonStatus gnomon_intersect_n(const struct GnomonScene *scene,
                                const struct GnomonRay *rays,
                                size_t count,
                                struct GnomonHit *hits_out,
                                const struct GnomonQueryOptions *options);

// As `gnomon_occluded` for each of `count` rays, shared out among threads.
//
// `occluded_out` gets one byte a ray, 1 where it hits anything and 0 where not; the two arrays must not overlap. The
// rest is as for `gnomon_intersect_n`.
GnomonStatus gnomon_occluded_n(const struct GnomonScene *scene,
                               const struct GnomonRay *rays,
                               size_t count,
                               uint8_t *occluded_out,
                               const struct GnomonQueryOptions *options);

// The hits of a ray, as many as there is room for: those that come first, or first after one that is known.
//
// They come in the order in which hits win: by `t`, then `geometry_id`, then `primitive_id`; in `GNOMON_PRECISION_EXACT` those
// whose `t` differ only before they are rounded keep the order of the exact ones. `hits_out` has room for `capacity` hits,
// and `count_out` gets how many are written: if fewer, there are no more; else call again with `&hits_out[capacity - 1]` as
// `after` for those that follow. NULL begins with what `gnomon_intersect` gives, to the bit. There is a hit just where
// `gnomon_occluded` is true.
//
// Each triangle is there at most once, also where the ray passes an edge or a vertex that several share: then each of them
// that the ray hits is there. Triangles that are the same are each there. A sphere is there where the ray enters and where
// it leaves it, once where both have the same `t`. A ray that is not valid has no hits.
//
// Crossings can be counted with this as long as no ray meets an edge: from inside of a closed mesh there is an odd number of
// hits up to `INFINITY`. But a ray through a shared edge may hit both triangles, though it passes one surface, and one that
// runs within a face hits nothing of it. `gnomon_contains_point` is right for every point.
//
// `after` must be a hit of the same ray in the same scene. The call keeps 56 bytes for a hit, at most for three times as many
// as are asked for; with `after`, for all that have its `t`. Any number of threads may call this on one scene.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer (`hits_out` may be NULL for a `capacity` of 0), an array that is
// not aligned for floats, or a capacity that no memory can hold; `GNOMON_ERROR_OUT_OF_MEMORY`. Nothing is written then.
GnomonStatus gnomon_intersect_all(const struct GnomonScene *scene,
                                  const struct GnomonRay *ray,
                                  const struct GnomonHit *after,
                                  size_t capacity,
                                  struct GnomonHit *hits_out,
                                  size_t *count_out);

// Whether a point is inside of closed meshes and spheres: whether a line that begins there leaves them an odd number of
// times.
//
// Exact for every finite point, in every structure and precision, also where lines from it run through edges and vertices
// or along faces. A point on a triangle or a sphere counts as inside; one that is not finite is outside.
//
// The triangles of the whole scene count as one surface. It is closed where each edge belongs to an even number of
// triangles, with the same end points to the bit (-0 is 0), in whichever meshes these are. How triangles are wound makes
// no difference. Where closed meshes or spheres overlap or are nested, what is inside of an even number of them is
// outside; triangles that are there twice cancel. Triangles of zero area do not count. If the surface is not
// closed, the answer is what the half-line towards +x crosses.
//
// `point` has three floats (x, y, z); `inside_out` gets the answer. Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null
// pointer; `GNOMON_ERROR_OUT_OF_MEMORY`. Any number of threads may call this on one scene.
//
// Source: Edelsbrunner and Muecke 1990, "Simulation of simplicity: a technique to cope with degenerate cases in geometric
// algorithms", ACM TOG 9(1).
GnomonStatus gnomon_contains_point(const struct GnomonScene *scene,
                                   const float point[3],
                                   bool *inside_out);

// Where a ray hit: the point, a bound on its error, and the normal. `hit` is what this scene answered to `ray`.
//
// The point is computed anew from the ray and the surface, not from `hit`, of which the ids count, and `t` to tell a sphere's
// two sides apart. The scene does not look for them: the first call makes a table of 4 bytes for each triangle and sphere,
// which stays with the scene and counts among its `bytes`; a scene that is never asked has none.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a hit that is a miss, a ray that is not valid, ids of what this
// scene does not have or no ray can hit, and a ray that does not hit what they name; `GNOMON_ERROR_OUT_OF_MEMORY` where there
// is no room for the table. Accuracy: see `GnomonSurfacePoint`; the same in every structure, precision and instruction set.
// Any number of threads may call this on one scene, the first call among them.
GnomonStatus gnomon_surface_point(const struct GnomonScene *scene,
                                  const struct GnomonRay *ray,
                                  const struct GnomonHit *hit,
                                  struct GnomonSurfacePoint *point_out);

// The origin of a ray that leaves a surface with that direction and `t_min` 0, and does not hit it again.
//
// `origin_out` gets three floats (x, y, z) strictly on that side of the exact surface that `direction` leads to: its plane's
// for a triangle, inside or outside for a sphere. A direction exactly along the surface leads to the side of the normal, or out
// of the sphere. The origin is off the surface by `error`, with 2^-40 of the surface's size and a rounding, and by more only
// where a triangle's own test, of the scene's precision, would still take the ray for a hit, because the ray passes an edge by less
// than the test's rounding: then by as much as it takes.
//
// What is promised: the ray from `origin_out` with this `direction`, to the bit, `t_min` 0 and any `t_max` does not hit the
// surface that it leaves; into a sphere it hits it once, where it leaves the sphere. A direction that is computed from the
// origin, towards a light for example, is as good in EXACT as long as it leads to the same side. Of other surfaces nothing
// is known here: one that touches or crosses this one nearer than the step may be hit at once, or lie behind the origin. Near
// inner edges of huge triangles, where ACCURATE may take the neighbour, that can lead out of a closed mesh; FAST may pass a surface
// that is nearer than its t rounds. In EXACT no ray did either.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a direction that is zero or not finite, a point that is not as
// `gnomon_surface_point` gives it, or one so far out that no float lies beyond it. Needs no scene. Any thread may call this.
//
// Sources: Waechter and Binder 2019, "A fast and robust method for avoiding self-intersection", Ray Tracing Gems, chapter 6;
// Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
GnomonStatus gnomon_offset_origin(const struct GnomonSurfacePoint *point,
                                  const float direction[3],
                                  float origin_out[3]);

// V(lambda), the sensitivity of the eye in daylight relative to its peak at 555 nm: in [0, 1], linear between whole nanometres, 0
// outside 360 to 830 nm and for a NaN. Source: CIE 1924, as in ISO/CIE 23539:2023, table 1. Any thread may call this.
double gnomon_photopic_luminosity(double wavelength_nm);

// The luminous flux of a radiant flux of one wavelength: `K_m V(lambda)` lumens a watt. Any thread may call this.
double gnomon_luminous_flux_lm(double radiant_flux_w,
                               double wavelength_nm);

// The luminous efficacy of light with a spectrum [lm/W]: what turns each radiant quantity of that light into the luminous one.
//
// `spectral_powers` has a power for each of the `count` rising `wavelengths_nm`, in any one unit for each nanometre, and changes
// linearly in between; a single one is a line. The integral over the tabulated V is exact but for rounding.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, no wavelength, wavelengths that are not finite, positive and rising,
// powers that are negative or not finite, or all 0. Any thread may call this.
GnomonStatus gnomon_luminous_efficacy_lm_per_w(const double *wavelengths_nm,
                                               const double *spectral_powers,
                                               size_t count,
                                               double *efficacy_out);

// The intensity of a point that sends its flux out evenly in all directions: `I = flux / 4 pi`; 815 lm are 64.9 cd. Any thread may
// call this, as all of these.
double gnomon_isotropic_intensity_cd(double flux_lm);

// The flux of a point that has that intensity in all directions.
double gnomon_isotropic_flux_lm(double intensity_cd);

// As `gnomon_isotropic_intensity_cd`, radiant.
double gnomon_isotropic_intensity_w_per_sr(double flux_w);

// As `gnomon_isotropic_flux_lm`, radiant.
double gnomon_isotropic_flux_w(double intensity_w_per_sr);

// The luminance of a surface that looks alike from all sides of its front (Lambert): `L = M / pi`, in nt, that is cd/m^2. The
// exitance is in lm/m^2.
double gnomon_lambertian_luminance_nt(double exitance_lm_per_m2);

// The luminous exitance of a surface with that luminance in all directions of its front: `M = pi L`.
double gnomon_lambertian_exitance_lm_per_m2(double luminance_nt);

// As `gnomon_lambertian_luminance_nt`, radiant.
double gnomon_lambertian_radiance_w_per_m2_sr(double exitance_w_per_m2);

// As `gnomon_lambertian_exitance_lm_per_m2`, radiant.
double gnomon_lambertian_exitance_w_per_m2(double radiance_w_per_m2_sr);

// The flux of a spot by its intensity on the axis; it fades between the cones as glTF says: `gnomon_spot_attenuation`, of which this is
// the integral in closed form.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, and unless `0 <= inner < outer <= pi / 2`.
GnomonStatus gnomon_spot_flux_lm(double intensity_cd,
                                 double inner_cone_rad,
                                 double outer_cone_rad,
                                 double *flux_lm_out);

// The intensity on the axis of a spot by its flux: see `gnomon_spot_flux_lm`.
GnomonStatus gnomon_spot_intensity_cd(double flux_lm,
                                      double inner_cone_rad,
                                      double outer_cone_rad,
                                      double *intensity_cd_out);

// `sin(theta) dtheta dphi`, the solid angle of a small patch at the angle theta from the pole [sr]. Any thread may call this, as
// all of these.
double gnomon_differential_solid_angle_sr(double theta_rad,
                                          double dtheta_rad,
                                          double dphi_rad);

// The integral of that over a patch of latitude and longitude [sr]; as precise for thin patches as for wide ones.
double gnomon_patch_solid_angle_sr(double theta_min_rad,
                                   double theta_max_rad,
                                   double phi_min_rad,
                                   double phi_max_rad);

// Of a circular cone around an axis: `2 pi (1 - cos)`, without cancellation [sr]; a NaN unless the half angle is in [0, pi].
double gnomon_cone_solid_angle_sr(double half_angle_rad);

// Of a cap of a sphere, seen from the sphere's centre: `2 pi height / radius` [sr]; a NaN unless the height is in [0, 2 radius].
double gnomon_cap_solid_angle_sr(double height,
                                 double radius);

// Of a sphere whose centre is that far away [sr]: 4 pi from inside, 2 pi from its surface; a NaN where either is negative or a NaN.
double gnomon_sphere_solid_angle_sr(double distance,
                                    double radius);

// Of a triangle, seen from a point [sr]: 0 to 2 pi, whichever way round its vertices a, b, c go; 2 pi from a point inside it, 0 from one of
// its plane outside it.
//
// Relative error some 2^-50; within a distance d of an edge, the vertices r away, an absolute one of 2^-50 r / d. A null pointer or
// a coordinate that is not finite gives a NaN and sets `gnomon_last_error`.
//
// Source: Van Oosterom and Strackee 1983, "The solid angle of a plane triangle", equation 8.
double gnomon_triangle_solid_angle_sr(const float point[3],
                                      const float a[3],
                                      const float b[3],
                                      const float c[3]);

// Of a planar polygon, which may be concave, seen from a point [sr].
//
// `vertices` has three floats (x, y, z) for each of the `vertex_count` vertices, in order around the border; fewer than three cover
// nothing. A border that is not planar counts each direction as often as it goes around it, up to multiples of 4 pi. Accuracy: as a fan
// of triangles, see `gnomon_triangle_solid_angle_sr`.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a coordinate that is not finite, or a count that no memory can hold;
// `GNOMON_ERROR_OUT_OF_MEMORY`.
GnomonStatus gnomon_polygon_solid_angle_sr(const float point[3],
                                           const float *vertices,
                                           size_t vertex_count,
                                           double *solid_angle_sr_out);

// Of an axis-aligned box, seen from a point [sr]: 4 pi from inside, 2 pi from a face, pi from an edge, pi / 2 from a corner. A box with
// `lower` above `upper` on an axis covers nothing. Accuracy and bad input: as `gnomon_triangle_solid_angle_sr`.
double gnomon_box_solid_angle_sr(const float point[3],
                                 const float lower[3],
                                 const float upper[3]);

// A direction uniform over the whole sphere: its density is `1 / 4 pi`. Any thread may call this, as all of these.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, and u or v outside [0, 1].
GnomonStatus gnomon_sample_sphere(double u,
                                  double v,
                                  struct GnomonDirectionSample *sample_out);

// A direction uniform over the side of a normal: its density is `1 / 2 pi`. The normal may have any length.
//
// Errors: as `gnomon_sample_sphere`, and a normal that is zero or not finite.
GnomonStatus gnomon_sample_hemisphere(const float normal[3],
                                      double u,
                                      double v,
                                      struct GnomonDirectionSample *sample_out);

// A direction on the side of a normal with the density `cosine / pi`: as a Lambertian surface scatters. Errors: as
// `gnomon_sample_hemisphere`.
GnomonStatus gnomon_sample_cosine_hemisphere(const float normal[3],
                                             double u,
                                             double v,
                                             struct GnomonDirectionSample *sample_out);

// A direction uniform over a cone around an axis of any length: its density is one over `gnomon_cone_solid_angle_sr`.
//
// Errors: as `gnomon_sample_hemisphere`, and a half angle that is not in (0, pi].
GnomonStatus gnomon_sample_cone(const float axis[3],
                                double half_angle_rad,
                                double u,
                                double v,
                                struct GnomonDirectionSample *sample_out);

// A direction from a point towards a triangle, uniform in solid angle, for small triangles too: its density is one over
// `gnomon_triangle_solid_angle_sr`; 0 where that is 0.
//
// Rounded to float it may pass a triangle that it meets by less than the rounding. Errors: as `gnomon_sample_sphere`, and
// coordinates that are not finite. Source: Arvo 1995, "Stratified sampling of spherical triangles"; Peters 2021, "BRDF importance
// sampling for polygonal lights", section 4.
GnomonStatus gnomon_sample_triangle(const float point[3],
                                    const float a[3],
                                    const float b[3],
                                    const float c[3],
                                    double u,
                                    double v,
                                    struct GnomonDirectionSample *sample_out);

// How bright the sources make a surface at a point, with shadows: the illuminance [lx] on the side of `normal`.
//
// `scene` is what may be in the way; NULL: nothing is. `normal` may have any length. `options` may be NULL for the defaults.
//
// A point, spot or direction takes a ray and is exact but for rounding. Spheres and triangles are known in closed form where nothing
// hides them, to about 2^-50 over the angle under which a triangle is seen. Where a scene may hide them, `sample_count` random rays, towards
// all of them together in proportion to what they would send, tell which share arrives; `standard_error_lx` says how far off that is. If
// all of them arrive the answer is the closed form, if none does it is 0, both without an error: of N rays less than 3 / N then may be
// hidden, or not, with 95 % confidence. The same seed gives the same answer, on any number of threads.
//
// What touches the point, or lies within 2^-22 of the distance from the source, is not in the way: sources may be part of the scene. In
// FAST that is 2^-12 for area sources, and a few rays in 100,000 to a triangle of the scene still hit it. A triangle that is seen end
// on sends nothing.
// For a point on a surface take the origin that `gnomon_offset_origin` gives for the normal, so that the surface is not in its own way.
//
// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a normal of length 0, whatever is not finite, negative values, cones and ranges
// that are none, indices out of range (the message names the source, and the triangle), a point or spot source right at the point, a
// `sample_count` below 2 where it matters; `GNOMON_ERROR_OUT_OF_MEMORY`. Any number of threads may call this on one scene.
//
// Sources: Lambert 1760, "Photometria" (polygons; as in Arvo 1995, "Analytic methods for simulated light transport", section 2.5.1);
// Snyder 1996, "Area light sources for real-time graphics" (spheres); Khronos, KHR_lights_punctual.
GnomonStatus gnomon_irradiance(const struct GnomonScene *scene,
                               const struct GnomonSources *sources,
                               const float point[3],
                               const float normal[3],
                               const struct GnomonIrradianceOptions *options,
                               struct GnomonIrradiance *irradiance_out);

// The share of a spot's intensity at an angle from its axis: `clamp((cos - cos outer) / (cos inner - cos outer), 0, 1)^2`; a NaN unless
// `0 <= inner < outer <= pi / 2`, and `gnomon_last_error` says why. Any thread may call this. Source: Khronos, KHR_lights_punctual,
// "Inner and outer cone angles".
double gnomon_spot_attenuation(double angle_rad,
                               double inner_cone_rad,
                               double outer_cone_rad);

// The share of a source's intensity that a range leaves at a distance: `max(min(1 - (distance / range)^4, 1), 0)`, besides the inverse
// square law; a range of 0 or `INFINITY` is none and leaves all. Any thread may call this. Source: Khronos, KHR_lights_punctual,
// "Range property".
double gnomon_range_attenuation(double distance_m,
                                double range_m);

// The version of the library that answers, as `major * 10000 + minor * 100 + patch`.
//
// Until version 1 a minor version may change the interface. Any thread may call this.
uint32_t gnomon_version(void);

// The same as text, for example "0.1.0". Static. Any thread may call this.
const char *gnomon_version_string(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GNOMON_H */
