//! Sources of light, as glTF's KHR_lights_punctual and KHR_materials_emissive_strength have them; and glowing spheres.
//!
//! Values are luminous, as theirs. All is linear in them: given in W/sr, W/m^2 or W/(m^2 sr), what arrives is in W/m^2.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec3};

use super::direction::{finite, unit};
use super::error::RadiometryError;
use super::quantity::{Illuminance, LuminousIntensity};
use crate::geometry::TriangleView;

/// All sources that there are. Those of a kind that a scene lacks cost nothing.
#[derive(Clone, Copy, Debug, Default)]
#[expect(missing_docs, reason = "the types say it")]
pub struct Sources<'a> {
    pub points: &'a [PointSource],
    pub spots: &'a [SpotSource],
    pub directionals: &'a [DirectionalSource],
    pub spheres: &'a [SphereSource],
    pub areas: &'a [AreaSource<'a>],
}

/// Shines from a point, evenly in all directions.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PointSource {
    /// Where it is.
    pub position: Vec3,
    /// In candela, not below 0.
    pub intensity_cd: f32,
    /// Beyond it nothing arrives: see [`range_attenuation`].
    pub range_m: f32,
}

/// Shines from a point into a cone.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SpotSource {
    /// Where it is.
    pub position: Vec3,
    /// On the axis, in candela, not below 0.
    pub intensity_cd: f32,
    /// The axis, away from the source, of any length.
    pub direction: Vec3,
    /// As [`PointSource::range_m`].
    pub range_m: f32,
    /// See [`Cone`].
    pub inner_cone_rad: f32,
    /// See [`Cone`].
    pub outer_cone_rad: f32,
}

/// Shines from so far away that its light is the same everywhere.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct DirectionalSource {
    /// In which the light travels, of any length.
    pub direction: Vec3,
    /// On a surface across the direction, in lux, not below 0.
    pub illuminance_lx: f32,
}

/// A sphere that looks equally bright from everywhere outside.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SphereSource {
    /// Where it is.
    pub centre: Vec3,
    /// Not below 0.
    pub radius: f32,
    /// In nits, not below 0.
    pub luminance_nt: f32,
}

/// Triangles that look equally bright from everywhere on their front side, from which their vertices go counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct AreaSource<'a> {
    /// In the caller's memory.
    pub triangles: TriangleView<'a>,
    /// In nits, not below 0.
    pub luminance_nt: f32,
    /// Whether the back shines as well.
    pub is_two_sided: bool,
}

/// How a spot fades from its axis on: `clamp((cos - cos outer) / (cos inner - cos outer), 0, 1)^2`.
///
/// Source: Khronos, KHR_lights_punctual, "Inner and outer cone angles".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// `1 - cos inner` and `cos inner - cos outer`, without cancellation.
    inner_height: f64,
    fade_height: f64,
}

impl Cone {
    /// `0 <= inner < outer <= pi / 2`, or an error. The `f32` above pi / 2 counts as pi / 2.
    pub fn new(inner_cone_rad: f64, outer_cone_rad: f64) -> Result<Self, RadiometryError> {
        let is_valid = 0.0 <= inner_cone_rad
            && inner_cone_rad < outer_cone_rad
            && outer_cone_rad <= f64::from(std::f32::consts::FRAC_PI_2);
        if !is_valid {
            return Err(RadiometryError::Cone { inner_cone_rad, outer_cone_rad });
        }
        let outer = outer_cone_rad.min(FRAC_PI_2);
        let fade_height = 2.0 * (0.5 * (outer + inner_cone_rad)).sin() * (0.5 * (outer - inner_cone_rad)).sin();
        Ok(Self { inner_height: height(inner_cone_rad), fade_height })
    }

    /// Of the intensity on the axis, at that angle from it: in `[0, 1]`. A NaN gives 0.
    pub fn attenuation(&self, angle_rad: f64) -> f64 {
        self.attenuation_at(height(angle_rad))
    }

    /// As [`Cone::attenuation`], for unit vectors.
    fn attenuation_along(&self, axis: DVec3, direction: DVec3) -> f64 {
        self.attenuation_at(0.5 * axis.distance_squared(direction))
    }

    fn attenuation_at(&self, height: f64) -> f64 {
        if height <= self.inner_height {
            return 1.0;
        }
        let share = 1.0 - (height - self.inner_height) / self.fade_height;
        if share > 0.0 { share * share } else { 0.0 }
    }

    /// The attenuation's integral over all directions: a spot's flux is its intensity times that.
    pub fn effective_solid_angle_sr(&self) -> f64 {
        2.0 * PI * (self.inner_height + self.fade_height / 3.0)
    }
}

/// `1 - cos`, without cancellation.
fn height(angle_rad: f64) -> f64 {
    let half_sine = (0.5 * angle_rad).sin();
    2.0 * half_sine * half_sine
}

/// Of the intensity, at that distance: `max(min(1 - (distance / range)^4, 1), 0)`. A range of 0 or infinity is none: 1.
///
/// Source: Khronos, KHR_lights_punctual, "Range property"; the inverse square law comes besides.
pub fn range_attenuation(distance_m: f64, range_m: f64) -> f64 {
    if range_m == 0.0 || range_m == f64::INFINITY {
        return 1.0;
    }
    (1.0 - (distance_m / range_m).powi(4)).clamp(0.0, 1.0)
}

/// Where light arrives: a point, and the unit normal of the side that is lit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Receiver {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

/// What a source would send to a receiver, were nothing in the way, and where it is to be looked for.
pub(super) struct Direct {
    pub(super) illuminance: Illuminance,
    /// From the receiver, of unit length.
    pub(super) to_source: DVec3,
    pub(super) distance: f64,
}

impl PointSource {
    pub(super) fn direct(&self, receiver: &Receiver) -> Result<Option<Direct>, RadiometryError> {
        shine(receiver, self.position, self.intensity_cd, self.range_m, |_| 1.0)
    }
}

impl SpotSource {
    pub(super) fn direct(&self, receiver: &Receiver) -> Result<Option<Direct>, RadiometryError> {
        let axis = unit("direction", self.direction.to_array())?;
        let cone = Cone::new(f64::from(self.inner_cone_rad), f64::from(self.outer_cone_rad))?;
        shine(receiver, self.position, self.intensity_cd, self.range_m, |away| cone.attenuation_along(axis, away))
    }
}

impl DirectionalSource {
    pub(super) fn direct(&self, receiver: &Receiver) -> Result<Option<Direct>, RadiometryError> {
        let illuminance_lx = not_negative("illuminance_lx", self.illuminance_lx)?;
        let to_source = -unit("direction", self.direction.to_array())?;
        let cosine = receiver.normal.dot(to_source);
        let illuminance = Illuminance::new(illuminance_lx) * cosine;
        let direct = Direct { illuminance, to_source, distance: f64::INFINITY };
        Ok((illuminance.value() > 0.0).then_some(direct))
    }
}

/// `attenuation` is asked for the unit direction away from the source. `None` where nothing arrives.
fn shine(
    receiver: &Receiver,
    position: Vec3,
    intensity_cd: f32,
    range_m: f32,
    attenuation: impl FnOnce(DVec3) -> f64,
) -> Result<Option<Direct>, RadiometryError> {
    let intensity = LuminousIntensity::new(not_negative("intensity_cd", intensity_cd)?);
    let is_range = range_m >= 0.0; // false for a NaN
    if !is_range {
        let expected = "above 0 (0 and infinity: no range)";
        return Err(RadiometryError::Value { what: "range_m", value: f64::from(range_m), expected });
    }
    let way = finite("position", position.to_array())? - receiver.point;
    let distance = way.length();
    if distance == 0.0 {
        return Err(RadiometryError::AtReceiver);
    }
    let to_source = way / distance;
    let share = range_attenuation(distance, f64::from(range_m)) * attenuation(-to_source);
    let illuminance = intensity.irradiance(distance, receiver.normal.dot(to_source)) * share;
    Ok((illuminance.value() > 0.0).then_some(Direct { illuminance, to_source, distance }))
}

pub(super) fn not_negative(what: &'static str, value: f32) -> Result<f64, RadiometryError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(f64::from(value));
    }
    Err(RadiometryError::Value { what, value: f64::from(value), expected: "a finite number from 0 on" })
}

#[cfg(test)]
mod tests {
    use gauss_quad::GaussLegendre;

    use super::*;

    #[test]
    fn a_spot_fades_as_gltf_says() {
        let cone = Cone::new(0.3, 0.7).expect("valid");
        assert_eq!(cone.attenuation(0.0), 1.0);
        assert_eq!(cone.attenuation(0.3), 1.0);
        assert!(cone.attenuation(0.7) < 1e-30);
        assert_eq!(cone.attenuation(0.701), 0.0);
        assert_eq!(cone.attenuation(PI), 0.0);
        assert_eq!(cone.attenuation(f64::NAN), 0.0);
        let middle = 0.5 * (0.3f64.cos() + 0.7f64.cos());
        assert!((cone.attenuation(middle.acos()) - 0.25).abs() < 1e-14);
        // As fine as a laser: the height grows with the square of the angle.
        let cone = Cone::new(0.0, 1e-9).expect("valid");
        assert_eq!(cone.attenuation(2e-9), 0.0);
        assert!((cone.attenuation(5e-10) - 0.75 * 0.75).abs() < 1e-14);
        assert!((cone.attenuation_along(DVec3::Z, DVec3::new(5e-10, 0.0, 1.0)) - 0.75 * 0.75).abs() < 1e-14);
    }

    #[test]
    fn the_effective_solid_angle_is_the_integral_of_the_attenuation() {
        let rule = GaussLegendre::new(16.try_into().expect("not 0"));
        for (inner, outer) in [(0.0, 0.5), (0.0, FRAC_PI_2), (0.3, 0.7), (1.0, 1.01), (1e-6, 2e-6)] {
            let cone = Cone::new(inner, outer).expect("valid");
            let ring = |theta: f64| cone.attenuation(theta) * 2.0 * PI * theta.sin();
            let integral = rule.integrate(0.0, inner, ring) + rule.integrate(inner, outer, ring);
            let relative = cone.effective_solid_angle_sr() / integral - 1.0;
            assert!(relative.abs() < 1e-12, "{inner} {outer}: {relative}");
        }
        assert!((Cone::new(0.0, FRAC_PI_2).expect("valid").effective_solid_angle_sr() - 2.0 * PI / 3.0).abs() < 1e-15);
    }

    #[test]
    fn cones_that_are_none_are_refused() {
        for (inner, outer) in [(0.5, 0.5), (0.6, 0.5), (-0.1, 0.5), (0.0, 1.6), (f64::NAN, 0.5), (0.1, f64::NAN)] {
            assert!(Cone::new(inner, outer).is_err(), "{inner} {outer}");
        }
        assert!(Cone::new(0.0, f64::from(std::f32::consts::FRAC_PI_2)).is_ok());
    }

    #[test]
    fn a_range_ends_what_arrives() {
        assert_eq!(range_attenuation(5.0, 0.0), 1.0);
        assert_eq!(range_attenuation(5.0, f64::INFINITY), 1.0);
        assert_eq!(range_attenuation(5.0, 10.0), 1.0 - 1.0 / 16.0);
        assert_eq!(range_attenuation(10.0, 10.0), 0.0);
        assert_eq!(range_attenuation(1e9, 10.0), 0.0);
    }
}
