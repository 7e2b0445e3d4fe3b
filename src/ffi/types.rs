//! Rays, hits, meshes, spheres, and what a scene tells about itself, as C sees them.

use std::ffi::c_void;
use std::mem::{MaybeUninit, offset_of};

use glam::{Vec3, Vec4};

use crate::accel::RayCounts;
use crate::geometry::{Hit, Ray};

/// The id of what is not there: a miss's geometry and primitive, the instance where none is involved.
pub const GNOMON_INVALID_ID: u32 = 0xFFFF_FFFF;

/// `indices` are `uint16_t`.
pub const GNOMON_INDEX_U16: u32 = 1;
/// `indices` are `uint32_t`.
pub const GNOMON_INDEX_U32: u32 = 2;

/// `origin + t * direction` for `t` in the closed interval `[t_min, t_max]`. 32 bytes.
///
/// A ray with a NaN, an infinite origin or direction, a zero direction, or `t_min > t_max` misses everything. `t_max`
/// may be `INFINITY`, `t_min` may be negative.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonRay {
    /// Where `t` is 0, in the scene's units.
    pub origin: [f32; 3],
    /// Hits with `t_min <= t <= t_max` count.
    pub t_min: f32,
    /// Need not be of unit length: `t` counts in its lengths.
    pub direction: [f32; 3],
    /// See `t_min`.
    pub t_max: f32,
}

/// What a ray hits first. 36 bytes.
///
/// Of two hits with the same `t` the one with the lower `(geometry_id, primitive_id)` wins.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonHit {
    /// In lengths of the ray's direction; `INFINITY` for a miss.
    pub t: f32,
    /// The hit point is `(1 - u - v) * p0 + u * p1 + v * p2` of the triangle's vertices; 0 for a sphere and for a miss.
    pub u: f32,
    /// See `u`.
    pub v: f32,
    /// `(p1 - p0) x (p2 - p0)`, not normalised (Embree's `Ng`), each component rounded once from double; of a sphere from
    /// the centre to the hit, as long as the radius; 0 for a miss.
    pub normal: [f32; 3],
    /// The triangle's or sphere's index within its geometry; `GNOMON_INVALID_ID` for a miss.
    pub primitive_id: u32,
    /// What `gnomon_scene_builder_add_triangles` or `_add_spheres` gave; `GNOMON_INVALID_ID` for a miss.
    pub geometry_id: u32,
    /// `GNOMON_INVALID_ID` where no instance is involved.
    pub instance_id: u32,
}

/// A `GnomonSurfacePoint` of a triangle.
pub const GNOMON_SURFACE_TRIANGLE: u32 = 0;
/// A `GnomonSurfacePoint` of a sphere.
pub const GNOMON_SURFACE_SPHERE: u32 = 1;

/// The point where a ray hit a surface. 80 bytes.
///
/// It stands for the point where the exact ray meets the surface. Where FAST or ACCURATE took a triangle that the exact ray
/// passes by less than their rounding, it stands for a point of that triangle as near to the ray.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonSurfacePoint {
    /// The point, computed in double and rounded once.
    pub position: [f32; 3],
    /// The exact point is no further from `position` along each axis: proven, and seldom above `2^-24 * |position|`. Not
    /// below 0.
    pub error: [f32; 3],
    /// Of unit length, to the side that `GnomonHit.normal` points to. Of a triangle each component is within `0.51 * 2^-24`;
    /// of a sphere it is outward and besides off by no more than `error` is in radii.
    pub normal: [f32; 3],
    /// `GNOMON_SURFACE_*`.
    pub surface: u32,
    /// The scene's `GNOMON_PRECISION_*`.
    pub precision: u32,
    /// What `gnomon_offset_origin` needs of the surface: a triangle's vertices, x, y and z of each; a sphere's centre and
    /// radius, then zeros.
    pub shape: [f32; 9],
}

/// What a query did to find its answer. 12 bytes.
///
/// The same in every run, so that structures can be compared where clocks are noisy. Instruction sets round the bounds
/// of boxes and hits differently, so now and then a ray takes a step more or less. A number that does not fit stays
/// at `UINT32_MAX`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonRayCounts {
    /// Nodes whose children's boxes were tested, in one step or one by one; a leaf is none.
    pub nodes_visited: u32,
    /// Cells that the ray was led through; 0 in structures without cells.
    pub cells_stepped: u32,
    /// Triangles and spheres of the leaves that were tested, each for itself or eight at once; without a structure, all.
    pub primitives_tested: u32,
}

/// A triangle mesh in the caller's memory, which `gnomon_scene_builder_add_triangles` copies.
///
/// No alignment is asked for, and nothing is read beyond the last byte of the last vertex and of the last index.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonTriangles {
    /// Three floats (x, y, z) at the start of each stride; may be null without vertices.
    pub positions: *const f32,
    /// Bytes from one vertex to the next, at least 12; 0 means 12.
    pub position_stride: usize,
    /// How many vertices there are.
    pub vertex_count: usize,
    /// Three indices at the start of each stride, each below `vertex_count`. NULL: the vertices are taken three by
    /// three.
    pub indices: *const c_void,
    /// `GNOMON_INDEX_U16` or `GNOMON_INDEX_U32`; not looked at without `indices`.
    pub index_format: u32,
    /// Bytes from one triangle to the next, at least three indices; 0 means just three indices.
    pub index_stride: usize,
    /// How many triangles there are; their place in the order is their `primitive_id`. May be 0.
    pub triangle_count: usize,
}

/// Spheres in the caller's memory, which `gnomon_scene_builder_add_spheres` copies.
///
/// No alignment is asked for, and nothing is read beyond the last byte of the last centre and of the last radius. For
/// spheres of four floats each (x, y, z, radius) let `centres` point to the first x, `radii` to the first radius, and both
/// strides be 16.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonSpheres {
    /// Three floats (x, y, z) at the start of each stride; may be null without spheres.
    pub centres: *const f32,
    /// Bytes from one centre to the next, at least 12; 0 means 12.
    pub centre_stride: usize,
    /// A float at the start of each stride, not below 0; a sphere of radius 0 is never hit. May be null without spheres.
    pub radii: *const f32,
    /// Bytes from one radius to the next, at least 4; 0 means 4.
    pub radius_stride: usize,
    /// How many there are; their place in the order is their `primitive_id`. May be 0.
    pub sphere_count: usize,
}

/// What a scene is made of. Later versions add fields at the end.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonSceneStats {
    /// Triangles that were added, without the skipped ones.
    pub triangle_count: u64,
    /// Nodes, leaves among them; the cells of a grid; 0 for brute force.
    pub node_count: u64,
    /// Nodes without children; the cells of a grid.
    pub leaf_count: u64,
    /// Triangles and spheres stored in leaves: not those of zero area or radius, which nothing hits, nor copies (equal to the
    /// bit) that a BVH cannot tell apart. Where leaves divide space, one counts in each that it overlaps.
    pub reference_count: u64,
    /// Triangles and spheres left out by `GNOMON_INVALID_SKIP`.
    pub skipped_count: u64,
    /// Nodes on the longest way from the root to a leaf, both counted; 0 without nodes.
    pub depth: u32,
    /// The `GNOMON_STRUCTURE_*` that was built.
    pub structure: u32,
    /// The `GNOMON_PRECISION_*` in use.
    pub precision: u32,
    /// The `GNOMON_ISA_*` in use.
    pub isa: u32,
    /// Memory that the scene holds.
    pub bytes: u64,
    /// Of these, for nodes.
    pub node_bytes: u64,
    /// Of these, for triangles and spheres.
    pub leaf_bytes: u64,
    /// The most that the build held at a time, the scene among it, the builder's copy of the meshes not.
    pub peak_build_bytes: u64,
    /// Wall-clock time of the build.
    pub build_seconds: f64,
    /// Expected cost of a random ray that meets the scene's box, in triangle tests (MacDonald and Booth 1990,
    /// "Heuristics for ray tracing using space subdivision"); NaN where it has no meaning. Triangles and spheres have a
    /// structure each: the sum of both.
    pub sah_cost: f64,
    /// Spheres that were added, without the skipped ones.
    pub sphere_count: u64,
}

impl From<&GnomonRay> for Ray {
    /// Reads a ray float by float. A caller has just written it so; a wider load would have to wait until those stores
    /// have left for the cache.
    #[inline(always)]
    fn from(ray: &GnomonRay) -> Self {
        // SAFETY: the reference is valid; volatile only keeps the compiler from merging the loads.
        let read = |field: &f32| unsafe { std::ptr::read_volatile(field) };
        let read3 = |[x, y, z]: &[f32; 3]| Vec3::new(read(x), read(y), read(z));
        Self {
            origin: read3(&ray.origin),
            t_min: read(&ray.t_min),
            direction: read3(&ray.direction),
            t_max: read(&ray.t_max),
        }
    }
}

impl From<Hit> for GnomonHit {
    fn from(hit: Hit) -> Self {
        Self {
            t: hit.t,
            u: hit.u,
            v: hit.v,
            normal: hit.normal.to_array(),
            primitive_id: hit.primitive_id,
            geometry_id: hit.geometry_id,
            instance_id: hit.instance_id,
        }
    }
}

impl GnomonHit {
    /// In three stores: a caller who copies the hit at once loads 16 bytes at a time, and a load that spans several stores
    /// waits until they have left for the cache.
    #[inline(always)]
    pub(super) fn write(hit: &Hit, out: &mut MaybeUninit<Self>) {
        let [x, y, z] = hit.normal.to_array();
        let ids = [hit.primitive_id, hit.geometry_id].map(f32::from_bits);
        let parts = [Vec4::new(hit.t, hit.u, hit.v, x), Vec4::new(y, z, ids[0], ids[1])];
        let out = out.as_mut_ptr();
        // SAFETY: `out` has room for 36 bytes; these are its first eight values and the last.
        unsafe {
            out.cast::<[Vec4; 2]>().write_unaligned(parts);
            (&raw mut (*out).instance_id).write(hit.instance_id);
        }
    }
}

const _: () = assert!(offset_of!(GnomonHit, normal) == 12 && offset_of!(GnomonHit, instance_id) == 32);

impl From<RayCounts> for GnomonRayCounts {
    fn from(counts: RayCounts) -> Self {
        Self {
            nodes_visited: counts.nodes_visited,
            cells_stepped: counts.cells_stepped,
            primitives_tested: counts.primitives_tested,
        }
    }
}

// Batches take the ones for the others.
const _: () = assert!(
    size_of::<Ray>() == size_of::<GnomonRay>()
        && align_of::<Ray>() == align_of::<GnomonRay>()
        && offset_of!(Ray, t_min) == offset_of!(GnomonRay, t_min)
        && offset_of!(Ray, direction) == offset_of!(GnomonRay, direction)
        && offset_of!(Ray, t_max) == offset_of!(GnomonRay, t_max)
);
const _: () = assert!(
    size_of::<Hit>() == size_of::<GnomonHit>()
        && align_of::<Hit>() == align_of::<GnomonHit>()
        && offset_of!(Hit, v) == offset_of!(GnomonHit, v)
        && offset_of!(Hit, normal) == offset_of!(GnomonHit, normal)
        && offset_of!(Hit, primitive_id) == offset_of!(GnomonHit, primitive_id)
        && offset_of!(Hit, geometry_id) == offset_of!(GnomonHit, geometry_id)
        && offset_of!(Hit, instance_id) == offset_of!(GnomonHit, instance_id)
);
const _: () = assert!(size_of::<GnomonRay>() == 32);
const _: () = assert!(size_of::<GnomonHit>() == 36);
const _: () = assert!(size_of::<GnomonRayCounts>() == 12);
const _: () = assert!(
    size_of::<GnomonSurfacePoint>() == 80
        && offset_of!(GnomonSurfacePoint, normal) == 24
        && offset_of!(GnomonSurfacePoint, surface) == 36
        && offset_of!(GnomonSurfacePoint, shape) == 44
);
const _: () = assert!(std::mem::offset_of!(GnomonRay, direction) == 16);
const _: () = assert!(std::mem::offset_of!(GnomonHit, primitive_id) == 24);
#[cfg(target_pointer_width = "64")]
const _: () = assert!(size_of::<GnomonTriangles>() == 56 && std::mem::offset_of!(GnomonTriangles, index_stride) == 40);
#[cfg(target_pointer_width = "64")]
const _: () = assert!(size_of::<GnomonSpheres>() == 40 && std::mem::offset_of!(GnomonSpheres, radii) == 16);
const _: () = assert!(
    size_of::<GnomonSceneStats>() == 112
        && std::mem::offset_of!(GnomonSceneStats, depth) == 40
        && std::mem::offset_of!(GnomonSceneStats, sah_cost) == 96
        && std::mem::offset_of!(GnomonSceneStats, sphere_count) == 104
);
const _: () = assert!(GNOMON_INVALID_ID == crate::geometry::INVALID_ID);
