//! Sources of light, and what arrives from them.

use super::builder::triangle_view;
use super::options::{GnomonIrradianceOptions, read_versioned};
use super::pointers::{output, required, slice};
use super::scene::GnomonScene;
use super::status::{Failure, GnomonStatus, guard, number_or_nan};
use super::types::GnomonTriangles;
use crate::radiometry::{
    AreaSource, Cone, DirectionalSource, IrradianceEstimate, PointSource, Sources, SphereSource, SpotSource,
    irradiance, range_attenuation,
};

/// Shines from a point evenly in all directions: glTF's point light. 20 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonPointSource {
    /// Where it is, in metres, as all lengths here.
    pub position: [f32; 3],
    /// Not below 0.
    pub intensity_cd: f32,
    /// What arrives is less the nearer that is, and nothing beyond: `gnomon_range_attenuation`. 0 and `INFINITY`: no range.
    pub range_m: f32,
}

/// Shines from a point into a cone: glTF's spot light. 40 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonSpotSource {
    /// Where it is.
    pub position: [f32; 3],
    /// On the axis; not below 0.
    pub intensity_cd: f32,
    /// The axis, away from the source, of any length.
    pub direction: [f32; 3],
    /// As `GnomonPointSource.range_m`.
    pub range_m: f32,
    /// From the axis up to here the intensity is that on the axis; `0 <= inner < outer`.
    pub inner_cone_rad: f32,
    /// From here on there is none; at most pi / 2. In between: `gnomon_spot_attenuation`.
    pub outer_cone_rad: f32,
}

/// Shines from so far away that its light is the same everywhere: glTF's directional light. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonDirectionalSource {
    /// In which the light travels, of any length.
    pub direction: [f32; 3],
    /// On a surface across the direction; not below 0.
    pub illuminance_lx: f32,
}

/// A sphere that looks equally bright from everywhere outside. 20 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonSphereSource {
    /// Where it is.
    pub centre: [f32; 3],
    /// Not below 0.
    pub radius: f32,
    /// Not below 0; in cd/m^2.
    pub luminance_nt: f32,
}

/// Triangles that look equally bright from everywhere on their front side, from which their vertices go counter-clockwise: glTF's
/// emissive material with KHR_materials_emissive_strength.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonAreaSource {
    /// In the caller's memory; they need not be, but may be, those of a geometry of the scene.
    pub triangles: GnomonTriangles,
    /// Not below 0; in cd/m^2.
    pub luminance_nt: f32,
    /// 1: the back shines as well; 0: it does not.
    pub is_two_sided: u32,
}

/// All sources of light. Zero it, set `struct_size`, then what there is: a kind of which there are none costs nothing.
///
/// What arrives is linear in their values: given in W/sr, W/m^2 and W/(m^2 sr) instead, it is in W/m^2.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonSources {
    /// `sizeof(GnomonSources)`, so that a program compiled against an older header keeps working.
    pub struct_size: u32,
    /// May be NULL where there are none, as all of these.
    pub points: *const GnomonPointSource,
    /// How many.
    pub point_count: usize,
    /// See `points`.
    pub spots: *const GnomonSpotSource,
    /// How many.
    pub spot_count: usize,
    /// See `points`.
    pub directionals: *const GnomonDirectionalSource,
    /// How many.
    pub directional_count: usize,
    /// See `points`.
    pub spheres: *const GnomonSphereSource,
    /// How many.
    pub sphere_count: usize,
    /// See `points`.
    pub areas: *const GnomonAreaSource,
    /// How many.
    pub area_count: usize,
}

/// What arrives at a point. 24 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnomonIrradiance {
    /// On a surface there, from all sources.
    pub illuminance_lx: f64,
    /// Of the part that is sampled: 0 where nothing is, and where all samples agree.
    pub standard_error_lx: f64,
    /// How many rays were traced.
    pub ray_count: u64,
}

/// As a slice of the type of the library with the same layout.
macro_rules! assert_same_layout {
    ($($c:ident = $rust:ident { $($field:ident),* };)*) => { $(
        const _: () = {
            assert!(size_of::<$c>() == size_of::<$rust>() && align_of::<$c>() == align_of::<$rust>());
            $(assert!(std::mem::offset_of!($c, $field) == std::mem::offset_of!($rust, $field));)*
        };
    )* };
}
assert_same_layout! {
    GnomonPointSource = PointSource { position, intensity_cd, range_m };
    GnomonSpotSource = SpotSource { position, intensity_cd, direction, range_m, inner_cone_rad, outer_cone_rad };
    GnomonDirectionalSource = DirectionalSource { direction, illuminance_lx };
    GnomonSphereSource = SphereSource { centre, radius, luminance_nt };
}

/// How bright the sources make a surface at a point, with shadows: the illuminance [lx] on the side of `normal`.
///
/// `scene` is what may be in the way; NULL: nothing is. `normal` may have any length. `options` may be NULL for the defaults.
///
/// A point, spot or direction takes a ray and is exact but for rounding. Spheres and triangles are known in closed form where nothing
/// hides them, to about 2^-50 over the angle under which a triangle is seen. Where a scene may hide them, `sample_count` random rays, towards
/// all of them together in proportion to what they would send, tell which share arrives; `standard_error_lx` says how far off that is. If
/// all of them arrive the answer is the closed form, if none does it is 0, both without an error: of N rays less than 3 / N then may be
/// hidden, or not, with 95 % confidence. The same seed gives the same answer, on any number of threads.
///
/// What touches the point, or lies within 2^-22 of the distance from the source, is not in the way: sources may be part of the scene. In
/// FAST that is 2^-12 for area sources, and a few rays in 100,000 to a triangle of the scene still hit it. A triangle that is seen end
/// on sends nothing.
/// For a point on a surface take the origin that `gnomon_offset_origin` gives for the normal, so that the surface is not in its own way.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, a normal of length 0, whatever is not finite, negative values, cones and ranges
/// that are none, indices out of range (the message names the source, and the triangle), a point or spot source right at the point, a
/// `sample_count` below 2 where it matters; `GNOMON_ERROR_OUT_OF_MEMORY`. Any number of threads may call this on one scene.
///
/// Sources: Lambert 1760, "Photometria" (polygons; as in Arvo 1995, "Analytic methods for simulated light transport", section 2.5.1);
/// Snyder 1996, "Area light sources for real-time graphics" (spheres); Khronos, KHR_lights_punctual.
///
/// # Safety
/// `scene` is null or from `gnomon_scene_build`; `sources` is null or describes readable memory; `point` and `normal` are null or
/// have three floats; `options` is null or filled in; `irradiance_out` is null or writable.
/// cbindgen:ptrs-as-arrays=[[point;3],[normal;3]]
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_irradiance(
    scene: *const GnomonScene,
    sources: *const GnomonSources,
    point: *const f32,
    normal: *const f32,
    options: *const GnomonIrradianceOptions,
    irradiance_out: *mut GnomonIrradiance,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let scene = unsafe { scene.as_ref() };
        // SAFETY: the caller's promise.
        let point = unsafe { required(point.cast(), "point") }?;
        // SAFETY: the caller's promise.
        let normal = unsafe { required(normal.cast(), "normal") }?;
        // SAFETY: the caller's promise.
        let options = unsafe { GnomonIrradianceOptions::read(options) }?;
        // SAFETY: the caller's promise.
        let irradiance_out = unsafe { output(irradiance_out, "irradiance_out") }?;
        // SAFETY: the caller's promise.
        let sources = unsafe { GnomonSources::read(sources) }?;
        // SAFETY: the caller's promise.
        let areas = unsafe { sources.parse_areas() }?;
        // SAFETY: the caller's promise.
        let sources = unsafe { sources.parse(&areas) }?;
        let scene = scene.map(|scene| &scene.0);
        irradiance_out.write(irradiance(scene, &sources, *point, *normal, &options.parse())?.into());
        Ok(())
    })
}

/// The share of a spot's intensity at an angle from its axis: `clamp((cos - cos outer) / (cos inner - cos outer), 0, 1)^2`; a NaN unless
/// `0 <= inner < outer <= pi / 2`, and `gnomon_last_error` says why. Any thread may call this. Source: Khronos, KHR_lights_punctual,
/// "Inner and outer cone angles".
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_spot_attenuation(angle_rad: f64, inner_cone_rad: f64, outer_cone_rad: f64) -> f64 {
    number_or_nan(|| Ok(Cone::new(inner_cone_rad, outer_cone_rad)?.attenuation(angle_rad)))
}

/// The share of a source's intensity that a range leaves at a distance: `max(min(1 - (distance / range)^4, 1), 0)`, besides the inverse
/// square law; a range of 0 or `INFINITY` is none and leaves all. Any thread may call this. Source: Khronos, KHR_lights_punctual,
/// "Range property".
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_range_attenuation(distance_m: f64, range_m: f64) -> f64 {
    range_attenuation(distance_m, range_m)
}

impl GnomonSources {
    const NONE: Self = Self {
        struct_size: size_of::<Self>() as u32,
        points: std::ptr::null(),
        point_count: 0,
        spots: std::ptr::null(),
        spot_count: 0,
        directionals: std::ptr::null(),
        directional_count: 0,
        spheres: std::ptr::null(),
        sphere_count: 0,
        areas: std::ptr::null(),
        area_count: 0,
    };

    /// # Safety
    /// `pointer` is null or points to a `struct_size` and as many bytes as it says.
    unsafe fn read(pointer: *const Self) -> Result<Self, Failure> {
        if pointer.is_null() {
            return Err(Failure::invalid("sources is null"));
        }
        // SAFETY: the caller's promise.
        unsafe { read_versioned(pointer, Self::NONE, size_of::<Self>(), "GnomonSources") }
    }

    /// # Safety
    /// The arrays are null or have as many elements as is said of them, and stay as they are while the answer lives.
    unsafe fn parse<'a>(&self, areas: &'a [AreaSource<'a>]) -> Result<Sources<'a>, Failure> {
        Ok(Sources {
            // SAFETY: the caller's promise; the layouts are the same, here and below.
            points: unsafe { slice(self.points.cast(), self.point_count, "points") }?,
            // SAFETY: see above.
            spots: unsafe { slice(self.spots.cast(), self.spot_count, "spots") }?,
            // SAFETY: see above.
            directionals: unsafe { slice(self.directionals.cast(), self.directional_count, "directionals") }?,
            // SAFETY: see above.
            spheres: unsafe { slice(self.spheres.cast(), self.sphere_count, "spheres") }?,
            areas,
        })
    }

    /// # Safety
    /// As [`GnomonSources::parse`].
    unsafe fn parse_areas<'a>(&self) -> Result<Vec<AreaSource<'a>>, Failure> {
        // SAFETY: the caller's promise.
        let areas: &'a [GnomonAreaSource] = unsafe { slice(self.areas, self.area_count, "areas") }?;
        let mut parsed = Vec::new();
        parsed
            .try_reserve_exact(areas.len())
            .map_err(|_| Failure::out_of_memory(format!("there is no memory for {} area sources", areas.len())))?;
        for (index, area) in areas.iter().enumerate() {
            // SAFETY: the caller's promise.
            let area = unsafe { area.parse() }.map_err(|cause| cause.within(&format!("area source {index}")))?;
            parsed.push(area);
        }
        Ok(parsed)
    }
}

impl GnomonAreaSource {
    /// # Safety
    /// What the triangles describe is readable and stays as it is.
    unsafe fn parse(&self) -> Result<AreaSource<'_>, Failure> {
        let is_two_sided = match self.is_two_sided {
            0 => false,
            1 => true,
            other => return Err(super::options::unknown("is_two_sided", other)),
        };
        // SAFETY: the caller's promise.
        let triangles = unsafe { triangle_view(&self.triangles) }?;
        Ok(AreaSource { triangles, luminance_nt: self.luminance_nt, is_two_sided })
    }
}

impl From<IrradianceEstimate> for GnomonIrradiance {
    fn from(estimate: IrradianceEstimate) -> Self {
        Self {
            illuminance_lx: estimate.illuminance.value(),
            standard_error_lx: estimate.standard_error.value(),
            ray_count: estimate.ray_count,
        }
    }
}
