//! Frames and lengths of directions.

use glam::DVec3;

use super::error::RadiometryError;

/// The direction with unit length, or an error that names it.
pub(crate) fn unit(what: &'static str, direction: [f32; 3]) -> Result<DVec3, RadiometryError> {
    let problem = |problem| RadiometryError::Vector { what, value: direction, problem };
    let wide = DVec3::from_array(direction.map(f64::from));
    if !wide.is_finite() {
        return Err(problem("not finite"));
    }
    // The squares of floats neither overflow nor vanish in f64.
    wide.try_normalize().ok_or_else(|| problem("zero"))
}

/// A point with finite coordinates, or an error that names it.
pub(crate) fn finite(what: &'static str, point: [f32; 3]) -> Result<DVec3, RadiometryError> {
    let wide = DVec3::from_array(point.map(f64::from));
    if wide.is_finite() { Ok(wide) } else { Err(RadiometryError::Vector { what, value: point, problem: "not finite" }) }
}

/// From coordinates in which `axis`, a unit vector, is z.
///
/// Source: Duff et al. 2017, "Building an orthonormal basis, revisited", JCGT 6(1), listing 3.
pub(super) fn from_local(axis: DVec3, local: DVec3) -> DVec3 {
    let sign = 1.0f64.copysign(axis.z);
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    let tangent = DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
    let bitangent = DVec3::new(b, sign + axis.y * axis.y * a, -axis.y);
    local.x * tangent + local.y * bitangent + local.z * axis
}
