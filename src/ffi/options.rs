//! Options with a version: the struct's size says which fields the caller knows.

use std::ffi::c_void;

use super::pointers::output;
use super::status::{Failure, guard};
use crate::accel::{Precision, Quality, Structure};
use crate::radiometry::IrradianceOptions;
use crate::scene::{BuildOptions, InvalidTriangles};
use crate::simd::Isa;

/// The best there is for the scene: brute force for a handful of triangles, else the wide BVH.
pub const GNOMON_STRUCTURE_AUTO: u32 = 0;
/// Every triangle is asked: for a handful, and as a reference.
pub const GNOMON_STRUCTURE_BRUTE_FORCE: u32 = 1;
/// Uniform grid: for triangles of one size, evenly spread.
pub const GNOMON_STRUCTURE_GRID: u32 = 2;
/// Octree: for scenes that are empty here and crowded there.
pub const GNOMON_STRUCTURE_OCTREE: u32 = 3;
/// kd-tree: planes across the axes, each triangle in the leaves that it reaches into. At most 2^28 - 1 triangles.
pub const GNOMON_STRUCTURE_KD_TREE: u32 = 4;
/// BSP tree: planes of 13 fixed directions and of the triangles themselves. Slow to build. At most 2^28 - 1 triangles.
pub const GNOMON_STRUCTURE_BSP_TREE: u32 = 5;
/// Binary bounding volume hierarchy.
pub const GNOMON_STRUCTURE_BVH: u32 = 6;
/// Bounding volume hierarchy with 8 children a node, tested at once by SSE4.2 or AVX2 where the CPU has it: the fastest
/// and smallest here. At most 2^28 triangles.
pub const GNOMON_STRUCTURE_WIDE_BVH: u32 = 7;

/// Fastest build. GRID: 2 cells a triangle. OCTREE: leaves of 16 triangles, where there are as many. KD_TREE: split at the
/// median, the axes in turn. BSP_TREE: the fixed directions alone. BVH: split at the median of the longest axis. WIDE_BVH:
/// split in Morton order (Lauterbach et al. 2009).
pub const GNOMON_QUALITY_LOW: u32 = 0;
/// Good for both. GRID: 6 cells a triangle. OCTREE: leaves of 8. KD_TREE: surface area heuristic over clipped triangles
/// (Wald and Havran 2006). BSP_TREE: the same over all its planes (Ize, Wald, Parker 2008). BVH and WIDE_BVH: binned surface
/// area heuristic (Wald 2007).
pub const GNOMON_QUALITY_MEDIUM: u32 = 1;
/// Best queries. GRID: 12 cells a triangle. OCTREE: leaves of 6. KD_TREE and BSP_TREE: as MEDIUM. BVH and WIDE_BVH: as
/// MEDIUM, with spatial splits where they pay (Stich, Friedrich, Dietrich 2009), then improved by reinsertion (Meister and
/// Bittner 2018).
pub const GNOMON_QUALITY_HIGH: u32 = 2;

/// Decided in float, watertight; t, u and v come from what decided. For previews.
pub const GNOMON_PRECISION_FAST: u32 = 0;
/// Decided as FAST; t within 0.51 ulp, u and v within 0.52 * 2^-24 of the exact values. For rendering; the default.
pub const GNOMON_PRECISION_ACCURATE: u32 = 1;
/// Decided as if nothing was ever rounded, for every finite ray and triangle: which triangles are hit, and which first. t is the
/// float nearest to the exact value, u and v are as with ACCURATE; the interval is that of the rounded t, so that a ray that ends
/// at its hit's t hits again. For acoustics, particle transport and CAD: 4 to 6 % slower than ACCURATE. Hits at the same exact t, and
/// those of a sphere at the same rounded one, are told apart by their ids.
pub const GNOMON_PRECISION_EXACT: u32 = 2;

/// The best instruction set that the CPU has.
pub const GNOMON_ISA_AUTO: u32 = 0;
/// No vector instructions beyond the compiler's baseline.
pub const GNOMON_ISA_SCALAR: u32 = 1;
/// At most SSE4.2.
pub const GNOMON_ISA_SSE42: u32 = 2;
/// At most AVX2 and FMA.
pub const GNOMON_ISA_AVX2: u32 = 3;
/// At most AVX-512 F, VL, DQ and BW.
pub const GNOMON_ISA_AVX512: u32 = 4;

/// A triangle with a coordinate that is not finite fails the build, which names the first one. The default.
pub const GNOMON_INVALID_REJECT: u32 = 0;
/// Such a triangle is left out and counted in the stats; the others keep their ids.
pub const GNOMON_INVALID_SKIP: u32 = 1;

/// Told the share of a build that is done, in [0, 1] and never falling, and `progress_user`. Returning false cancels
/// the build.
///
/// Called on the thread that called `gnomon_scene_build`, at 0, about every 10 ms, and at 1. It may throw a C++
/// exception: the build is cancelled, and the exception passes through `gnomon_scene_build`.
pub type GnomonProgress = Option<extern "C-unwind" fn(user: *mut c_void, done: f64) -> bool>;

/// How to build a scene. Fill it with `gnomon_build_options_init`, then change what you like.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonBuildOptions {
    /// `sizeof(GnomonBuildOptions)`, so that a program compiled against an older header keeps working.
    pub struct_size: u32,
    /// `GNOMON_STRUCTURE_*`; by default `_AUTO`.
    pub structure: u32,
    /// `GNOMON_QUALITY_*`; by default `_MEDIUM`.
    pub quality: u32,
    /// `GNOMON_PRECISION_*`; by default `_ACCURATE`.
    pub precision: u32,
    /// `GNOMON_ISA_*`, the most that queries may use, so that one machine can test every path; by default `_AUTO`.
    /// The answers do not depend on it.
    pub isa: u32,
    /// Threads of the build; 0, the default: as many as the machine has. The scene does not depend on it.
    pub thread_count: u32,
    /// `GNOMON_INVALID_*`; by default `_REJECT`.
    pub invalid_triangles: u32,
    /// What the build may hold at a time, the builder's copy of the meshes not counted; a build that would pass it
    /// fails with `GNOMON_ERROR_OUT_OF_MEMORY` before it allocates. 0, the default: no limit.
    pub memory_limit_bytes: u64,
    /// NULL, the default: nobody is told.
    pub progress: GnomonProgress,
    /// Passed on to `progress`.
    pub progress_user: *mut c_void,
    /// 1: a WIDE_BVH stores each vertex of a leaf once, which takes a third less memory of a mesh and makes queries
    /// slower, by up to a fifth; at most 44 million triangles. The answers are the same. 0, the default: it does
    /// not. No other structure is changed by it.
    pub compact: u32,
    /// How many cells a GRID has for each triangle, roughly; fewer where its lists would take too much memory. 0, the
    /// default: 2, 6 or 12 by quality. More make a difference where rays pass much that is empty; 27 is a number often
    /// taught. No other structure is changed by it.
    pub grid_cells_per_triangle: f32,
}

/// How to answer a batch. Fill it with `gnomon_query_options_init`, then change what you like.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonQueryOptions {
    /// `sizeof(GnomonQueryOptions)`, so that a program compiled against an older header keeps working.
    pub struct_size: u32,
    /// The most threads to use; 0, the default: as many as the machine has; 1: the calling thread alone.
    pub thread_count: u32,
}

/// How hard `gnomon_irradiance` tries. Fill it with `gnomon_irradiance_options_init`, then change what you like.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonIrradianceOptions {
    /// `sizeof(GnomonIrradianceOptions)`, so that a program compiled against an older header keeps working.
    pub struct_size: u32,
    /// As in `GnomonQueryOptions`. The answer does not depend on it.
    pub thread_count: u32,
    /// Rays towards spheres and triangles, all together; by default 4096.
    pub sample_count: u64,
    /// The same one gives the same answer; by default 0.
    pub seed: u64,
}

const _: () = assert!(std::mem::offset_of!(GnomonBuildOptions, memory_limit_bytes) == 32);
#[cfg(target_pointer_width = "64")]
const _: () = assert!(size_of::<GnomonBuildOptions>() == 64);
const _: () = assert!(size_of::<GnomonQueryOptions>() == 8);
const _: () = assert!(size_of::<GnomonIrradianceOptions>() == 24);

impl GnomonBuildOptions {
    /// The first header ended with `progress_user`.
    const FIRST_BYTES: usize = std::mem::offset_of!(Self, compact);
    const DEFAULT: Self = Self {
        struct_size: size_of::<Self>() as u32,
        structure: GNOMON_STRUCTURE_AUTO,
        quality: GNOMON_QUALITY_MEDIUM,
        precision: GNOMON_PRECISION_ACCURATE,
        isa: GNOMON_ISA_AUTO,
        thread_count: 0,
        invalid_triangles: GNOMON_INVALID_REJECT,
        memory_limit_bytes: 0,
        progress: None,
        progress_user: std::ptr::null_mut(),
        compact: 0,
        grid_cells_per_triangle: 0.0,
    };

    /// The caller's options, or the defaults for NULL.
    ///
    /// # Safety
    /// `pointer` is null or points to a `struct_size` and as many bytes as it says.
    pub(super) unsafe fn read(pointer: *const Self) -> Result<Self, Failure> {
        // SAFETY: the caller's promise.
        unsafe { read_versioned(pointer, Self::DEFAULT, Self::FIRST_BYTES, "GnomonBuildOptions") }
    }

    pub(super) fn parse(&self) -> Result<BuildOptions, Failure> {
        Ok(BuildOptions {
            structure: structure(self.structure)?,
            quality: match self.quality {
                GNOMON_QUALITY_LOW => Quality::Low,
                GNOMON_QUALITY_MEDIUM => Quality::Medium,
                GNOMON_QUALITY_HIGH => Quality::High,
                other => return Err(unknown("quality", other)),
            },
            precision: precision(self.precision)?,
            isa: match self.isa {
                GNOMON_ISA_AUTO => Isa::Auto,
                GNOMON_ISA_SCALAR => Isa::Scalar,
                GNOMON_ISA_SSE42 => Isa::Sse42,
                GNOMON_ISA_AVX2 => Isa::Avx2,
                GNOMON_ISA_AVX512 => Isa::Avx512,
                other => return Err(unknown("isa", other)),
            },
            thread_count: self.thread_count,
            invalid_triangles: match self.invalid_triangles {
                GNOMON_INVALID_REJECT => InvalidTriangles::Reject,
                GNOMON_INVALID_SKIP => InvalidTriangles::Skip,
                other => return Err(unknown("invalid_triangles", other)),
            },
            memory_limit_bytes: self.memory_limit_bytes,
            is_compact: match self.compact {
                0 => false,
                1 => true,
                other => return Err(unknown("compact", other)),
            },
            grid_cells_per_triangle: match self.grid_cells_per_triangle {
                cells if cells >= 0.0 && cells.is_finite() => cells,
                other => {
                    let told = format!("grid_cells_per_triangle is {other}, not 0 or a finite number above it");
                    return Err(Failure::invalid(told));
                }
            },
        })
    }
}

impl GnomonQueryOptions {
    const DEFAULT: Self = Self { struct_size: size_of::<Self>() as u32, thread_count: 0 };

    /// The caller's options, or the defaults for NULL.
    ///
    /// # Safety
    /// `pointer` is null or points to a `struct_size` and as many bytes as it says.
    pub(super) unsafe fn read(pointer: *const Self) -> Result<Self, Failure> {
        // SAFETY: the caller's promise.
        unsafe { read_versioned(pointer, Self::DEFAULT, size_of::<Self>(), "GnomonQueryOptions") }
    }
}

impl GnomonIrradianceOptions {
    const DEFAULT: Self = Self { struct_size: size_of::<Self>() as u32, thread_count: 0, sample_count: 4096, seed: 0 };

    /// The caller's options, or the defaults for NULL.
    ///
    /// # Safety
    /// `pointer` is null or points to a `struct_size` and as many bytes as it says.
    pub(super) unsafe fn read(pointer: *const Self) -> Result<Self, Failure> {
        // SAFETY: the caller's promise.
        unsafe { read_versioned(pointer, Self::DEFAULT, size_of::<Self>(), "GnomonIrradianceOptions") }
    }

    pub(super) fn parse(&self) -> IrradianceOptions {
        IrradianceOptions { sample_count: self.sample_count, seed: self.seed, thread_count: self.thread_count }
    }
}

fn structure(number: u32) -> Result<Structure, Failure> {
    Ok(match number {
        GNOMON_STRUCTURE_AUTO => Structure::Auto,
        GNOMON_STRUCTURE_BRUTE_FORCE => Structure::BruteForce,
        GNOMON_STRUCTURE_GRID => Structure::Grid,
        GNOMON_STRUCTURE_OCTREE => Structure::Octree,
        GNOMON_STRUCTURE_KD_TREE => Structure::KdTree,
        GNOMON_STRUCTURE_BSP_TREE => Structure::BspTree,
        GNOMON_STRUCTURE_BVH => Structure::Bvh,
        GNOMON_STRUCTURE_WIDE_BVH => Structure::WideBvh,
        other => return Err(unknown("structure", other)),
    })
}

pub(super) fn structure_number(structure: Structure) -> u32 {
    match structure {
        Structure::Auto => GNOMON_STRUCTURE_AUTO,
        Structure::BruteForce => GNOMON_STRUCTURE_BRUTE_FORCE,
        Structure::Grid => GNOMON_STRUCTURE_GRID,
        Structure::Octree => GNOMON_STRUCTURE_OCTREE,
        Structure::KdTree => GNOMON_STRUCTURE_KD_TREE,
        Structure::BspTree => GNOMON_STRUCTURE_BSP_TREE,
        Structure::Bvh => GNOMON_STRUCTURE_BVH,
        Structure::WideBvh => GNOMON_STRUCTURE_WIDE_BVH,
    }
}

pub(super) fn precision_number(precision: Precision) -> u32 {
    match precision {
        Precision::Fast => GNOMON_PRECISION_FAST,
        Precision::Accurate => GNOMON_PRECISION_ACCURATE,
        Precision::Exact => GNOMON_PRECISION_EXACT,
    }
}

pub(super) fn precision(number: u32) -> Result<Precision, Failure> {
    Ok(match number {
        GNOMON_PRECISION_FAST => Precision::Fast,
        GNOMON_PRECISION_ACCURATE => Precision::Accurate,
        GNOMON_PRECISION_EXACT => Precision::Exact,
        other => return Err(unknown("precision", other)),
    })
}

pub(super) fn isa_number(isa: Isa) -> u32 {
    match isa {
        Isa::Auto => GNOMON_ISA_AUTO,
        Isa::Scalar => GNOMON_ISA_SCALAR,
        Isa::Sse42 => GNOMON_ISA_SSE42,
        Isa::Avx2 => GNOMON_ISA_AVX2,
        Isa::Avx512 => GNOMON_ISA_AVX512,
    }
}

pub(super) fn unknown(field: &str, number: u32) -> Failure {
    Failure::invalid(format!("{field} is {number}, which has no meaning"))
}

/// Reads options whose `struct_size` says how many bytes there are: those that the first header stated, or more. What an
/// older header does not have keeps its default; a newer one is refused if a field that this library does not know is set.
///
/// # Safety
/// `pointer` is null or points to a `u32` that states a size, and to as many bytes as it says. `T` is a C struct of
/// plain numbers and pointers that begins with that size.
pub(super) unsafe fn read_versioned<T: Copy>(
    pointer: *const T,
    defaults: T,
    first_bytes: usize,
    name: &str,
) -> Result<T, Failure> {
    /// No version of any of these structs comes near; a size beyond it is garbage.
    const LARGEST: usize = 4096;

    if pointer.is_null() {
        return Ok(defaults);
    }
    let known = size_of::<T>();
    // SAFETY: the caller's promise; a u32 may be read from any address.
    let size = unsafe { pointer.cast::<u32>().read_unaligned() } as usize;
    if !(first_bytes..=LARGEST).contains(&size) {
        return Err(Failure::invalid(format!(
            "{name}: struct_size is {size}, not {known}; set it to sizeof({name}), as an _init function does"
        )));
    }
    // SAFETY: the caller's promise.
    let bytes = unsafe { std::slice::from_raw_parts(pointer.cast::<u8>(), size) };
    if bytes.iter().skip(known).any(|&byte| byte != 0) {
        return Err(Failure::invalid(format!(
            "{name}: struct_size is {size}, this library knows {known} bytes, and a field beyond them is set"
        )));
    }
    let mut options = defaults;
    // SAFETY: both have that many bytes, by the stated size, the caller's promise and the size of T; any bytes make the
    // numbers and pointers that T consists of.
    unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), (&raw mut options).cast::<u8>(), size.min(known)) };
    Ok(options)
}

/// Fills in the defaults. A null pointer is an error that `gnomon_last_error` tells.
///
/// # Safety
/// `options_out` is null or points to a `GnomonBuildOptions`.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_build_options_init(options_out: *mut GnomonBuildOptions) {
    guard(|| {
        // SAFETY: the caller's promise.
        unsafe { output(options_out, "options_out") }?.write(GnomonBuildOptions::DEFAULT);
        Ok(())
    });
}

/// Fills in the defaults. A null pointer is an error that `gnomon_last_error` tells.
///
/// # Safety
/// `options_out` is null or points to a `GnomonQueryOptions`.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_query_options_init(options_out: *mut GnomonQueryOptions) {
    guard(|| {
        // SAFETY: the caller's promise.
        unsafe { output(options_out, "options_out") }?.write(GnomonQueryOptions::DEFAULT);
        Ok(())
    });
}

/// Fills in the defaults. A null pointer is an error that `gnomon_last_error` tells.
///
/// # Safety
/// `options_out` is null or points to a `GnomonIrradianceOptions`.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_irradiance_options_init(options_out: *mut GnomonIrradianceOptions) {
    guard(|| {
        // SAFETY: the caller's promise.
        unsafe { output(options_out, "options_out") }?.write(GnomonIrradianceOptions::DEFAULT);
        Ok(())
    });
}
