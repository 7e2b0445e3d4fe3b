//! Places along a space-filling curve, so that what is near in space is near in memory (Morton 1966, "A computer oriented
//! geodetic data base and a new technique in file sequencing").

use glam::{DVec3, Vec4};

use super::Reference;
use crate::geometry::Aabb;

/// The most bits of a code for each axis.
pub(super) const MOST_BITS: u32 = 21;

/// Cuts a box into cubes and numbers them.
pub(super) struct Curve {
    doubled_lower: DVec3,
    /// Cubes for each doubled length; 0 of a box that is a point.
    scale: f64,
}

impl Curve {
    /// At most 2^`bits` cubes along an axis.
    pub(super) fn new(bounds: &Aabb, bits: u32) -> Self {
        debug_assert!(bits <= MOST_BITS);
        let (lower, upper) = (bounds.lower.as_dvec3(), bounds.upper.as_dvec3());
        let scale = f64::from((1u32 << bits) - 1) / (2.0 * (upper - lower).max_element());
        Self { doubled_lower: 2.0 * lower, scale: if scale.is_finite() { scale } else { 0.0 } }
    }

    /// The number of the cube that has the centre of the reference's box: the bits of its coordinates by turns.
    #[inline(always)]
    pub(super) fn code(&self, reference: &Reference) -> u64 {
        let corner = |corner: Vec4| corner.truncate().as_dvec3();
        // In f64, where it does not overflow.
        let doubled_centre = corner(reference.bounds().lower()) - corner(reference.bounds().negated_upper());
        let cube = (doubled_centre - self.doubled_lower) * self.scale;
        spread(cube.x as u64) << 2 | spread(cube.y as u64) << 1 | spread(cube.z as u64)
    }
}

/// With two zeros before each of the lowest [`MOST_BITS`].
#[inline(always)]
fn spread(value: u64) -> u64 {
    let mut bits = value & ((1 << MOST_BITS) - 1);
    for (shift, mask) in [
        (32, 0x001F_0000_0000_FFFF),
        (16, 0x001F_0000_FF00_00FF),
        (8, 0x100F_00F0_0F00_F00F),
        (4, 0x10C3_0C30_C30C_30C3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn spread_bits_are_three_apart() {
        for bit in 0..MOST_BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread(u64::MAX), 0x1249_2492_4924_9249);
    }

    #[test]
    fn codes_of_cubes_order_octants_first() {
        let curve = Curve::new(&Aabb { lower: Vec3::splat(-1.0), upper: Vec3::ONE }, MOST_BITS);
        let code = |x: f32, y: f32, z: f32| {
            let at = Vec3::new(x, y, z);
            curve.code(&Reference::new(&Aabb { lower: at, upper: at }, 0, 0))
        };
        assert_eq!(code(-1.0, -1.0, -1.0), 0);
        assert_eq!(code(1.0, 1.0, 1.0), (1 << (3 * MOST_BITS)) - 1);
        assert_eq!(code(1.0, -1.0, -1.0), spread((1 << MOST_BITS) - 1) << 2);
        assert!(code(-0.1, 0.9, 0.9) < code(0.1, -0.9, -0.9));
    }

    #[test]
    fn a_box_that_is_a_point_has_one_code() {
        let point = Aabb { lower: Vec3::ONE, upper: Vec3::ONE };
        assert_eq!(Curve::new(&point, MOST_BITS).code(&Reference::new(&point, 0, 0)), 0);
    }
}
