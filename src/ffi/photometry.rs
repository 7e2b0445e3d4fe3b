//! Quantities of light and how they follow from one another.

use super::pointers::{output, slice};
use super::status::{Failure, GnomonStatus, guard};
use crate::radiometry::{
    Cone, Luminance, LuminousEfficacy, LuminousExitance, LuminousFlux, LuminousIntensity,
    MAX_LUMINOUS_EFFICACY_LM_PER_W, Radiance, RadiantExitance, RadiantFlux, RadiantIntensity, RadiometryError,
};

/// K_m, the luminous efficacy of light at 555 nm, where the eye is most sensitive [lm/W]. Source: "Principles governing photometry",
/// BIPM monograph, 2nd edition 2019.
pub const GNOMON_MAX_LUMINOUS_EFFICACY_LM_PER_W: f64 = 683.0;
const _: () = assert!(GNOMON_MAX_LUMINOUS_EFFICACY_LM_PER_W == MAX_LUMINOUS_EFFICACY_LM_PER_W);

/// V(lambda), the sensitivity of the eye in daylight relative to its peak at 555 nm: in [0, 1], linear between whole nanometres, 0
/// outside 360 to 830 nm and for a NaN. Source: CIE 1924, as in ISO/CIE 23539:2023, table 1. Any thread may call this.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_photopic_luminosity(wavelength_nm: f64) -> f64 {
    crate::radiometry::photopic_luminosity(wavelength_nm)
}

/// The luminous flux of a radiant flux of one wavelength: `K_m V(lambda)` lumens a watt. Any thread may call this.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_luminous_flux_lm(radiant_flux_w: f64, wavelength_nm: f64) -> f64 {
    RadiantFlux::new(radiant_flux_w).luminous(LuminousEfficacy::of_wavelength(wavelength_nm)).value()
}

/// The luminous efficacy of light with a spectrum [lm/W]: what turns each radiant quantity of that light into the luminous one.
///
/// `spectral_powers` has a power for each of the `count` rising `wavelengths_nm`, in any one unit for each nanometre, and changes
/// linearly in between; a single one is a line. The integral over the tabulated V is exact but for rounding.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, no wavelength, wavelengths that are not finite, positive and rising,
/// powers that are negative or not finite, or all 0. Any thread may call this.
///
/// # Safety
/// `wavelengths_nm` and `spectral_powers` are null or have `count` elements; `efficacy_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_luminous_efficacy_lm_per_w(
    wavelengths_nm: *const f64,
    spectral_powers: *const f64,
    count: usize,
    efficacy_out: *mut f64,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let wavelengths_nm = unsafe { slice(wavelengths_nm, count, "wavelengths_nm") }?;
        // SAFETY: the caller's promise.
        let spectral_powers = unsafe { slice(spectral_powers, count, "spectral_powers") }?;
        // SAFETY: the caller's promise.
        let efficacy_out = unsafe { output(efficacy_out, "efficacy_out") }?;
        efficacy_out.write(LuminousEfficacy::of_spectrum(wavelengths_nm, spectral_powers)?.value());
        Ok(())
    })
}

/// The intensity of a point that sends its flux out evenly in all directions: `I = flux / 4 pi`; 815 lm are 64.9 cd. Any thread may
/// call this, as all of these.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_isotropic_intensity_cd(flux_lm: f64) -> f64 {
    LuminousFlux::new(flux_lm).isotropic_intensity().value()
}

/// The flux of a point that has that intensity in all directions.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_isotropic_flux_lm(intensity_cd: f64) -> f64 {
    LuminousIntensity::new(intensity_cd).isotropic_flux().value()
}

/// As `gnomon_isotropic_intensity_cd`, radiant.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_isotropic_intensity_w_per_sr(flux_w: f64) -> f64 {
    RadiantFlux::new(flux_w).isotropic_intensity().value()
}

/// As `gnomon_isotropic_flux_lm`, radiant.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_isotropic_flux_w(intensity_w_per_sr: f64) -> f64 {
    RadiantIntensity::new(intensity_w_per_sr).isotropic_flux().value()
}

/// The luminance of a surface that looks alike from all sides of its front (Lambert): `L = M / pi`, in nt, that is cd/m^2. The
/// exitance is in lm/m^2.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_lambertian_luminance_nt(exitance_lm_per_m2: f64) -> f64 {
    LuminousExitance::new(exitance_lm_per_m2).lambertian_radiance().value()
}

/// The luminous exitance of a surface with that luminance in all directions of its front: `M = pi L`.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_lambertian_exitance_lm_per_m2(luminance_nt: f64) -> f64 {
    Luminance::new(luminance_nt).lambertian_exitance().value()
}

/// As `gnomon_lambertian_luminance_nt`, radiant.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_lambertian_radiance_w_per_m2_sr(exitance_w_per_m2: f64) -> f64 {
    RadiantExitance::new(exitance_w_per_m2).lambertian_radiance().value()
}

/// As `gnomon_lambertian_exitance_lm_per_m2`, radiant.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_lambertian_exitance_w_per_m2(radiance_w_per_m2_sr: f64) -> f64 {
    Radiance::new(radiance_w_per_m2_sr).lambertian_exitance().value()
}

/// The flux of a spot by its intensity on the axis; it fades between the cones as glTF says: `gnomon_spot_attenuation`, of which this is
/// the integral in closed form.
///
/// Errors: `GNOMON_ERROR_INVALID_ARGUMENT` for a null pointer, and unless `0 <= inner < outer <= pi / 2`.
///
/// # Safety
/// `flux_lm_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_spot_flux_lm(
    intensity_cd: f64,
    inner_cone_rad: f64,
    outer_cone_rad: f64,
    flux_lm_out: *mut f64,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let flux_lm_out = unsafe { output(flux_lm_out, "flux_lm_out") }?;
        let cone = Cone::new(inner_cone_rad, outer_cone_rad)?;
        flux_lm_out.write(LuminousIntensity::new(intensity_cd).spot_flux(cone).value());
        Ok(())
    })
}

/// The intensity on the axis of a spot by its flux: see `gnomon_spot_flux_lm`.
///
/// # Safety
/// `intensity_cd_out` is null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn gnomon_spot_intensity_cd(
    flux_lm: f64,
    inner_cone_rad: f64,
    outer_cone_rad: f64,
    intensity_cd_out: *mut f64,
) -> GnomonStatus {
    guard(|| {
        // SAFETY: the caller's promise.
        let intensity_cd_out = unsafe { output(intensity_cd_out, "intensity_cd_out") }?;
        let cone = Cone::new(inner_cone_rad, outer_cone_rad)?;
        intensity_cd_out.write(LuminousFlux::new(flux_lm).spot_intensity(cone).value());
        Ok(())
    })
}

impl From<RadiometryError> for Failure {
    fn from(error: RadiometryError) -> Self {
        match error {
            RadiometryError::OutOfMemory { .. } => Self::out_of_memory(error.to_string()),
            _ => Self::invalid(error.to_string()),
        }
    }
}
