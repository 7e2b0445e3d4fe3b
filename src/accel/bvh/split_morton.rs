//! The fastest build: references in the order of their centres' Morton codes, split where the highest bit changes that
//! not all have in common.
//!
//! Source: Lauterbach, Garland, Sengupta, Luebke, Manocha 2009, "Fast BVH construction on GPUs", section 3.

use glam::{DVec3, Vec4};
use rayon::prelude::*;

use super::build::{Split, SplitRule, union_together};
use crate::accel::reference::{Bounds8, Reference};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::Aabb;
use crate::simd::Simd;

/// Splits references that [`Morton::sort`] has put into their order.
pub(crate) struct Morton {
    /// Doubled, as centres are.
    origin: DVec3,
    /// Cells a unit of doubled length; 0 on an axis without extent.
    scale: DVec3,
    most_in_leaf: usize,
}

/// Of a code, for each axis.
const BITS: u32 = 21;

impl Morton {
    pub(crate) fn new(bounds: &Aabb, most_in_leaf: usize) -> Self {
        let (lower, upper) = (bounds.lower.as_dvec3(), bounds.upper.as_dvec3());
        // Cubes: the order then prefers no axis.
        let scale = f64::from((1u32 << BITS) - 1) / (2.0 * (upper - lower).max_element());
        let scale = if scale.is_finite() { scale } else { 0.0 };
        Self { origin: 2.0 * lower, scale: DVec3::splat(scale), most_in_leaf }
    }

    /// The bits of the cell's three coordinates by turns.
    #[inline(always)]
    fn code(&self, reference: &Reference) -> u64 {
        let centre = doubled_centre(reference);
        let cell = (centre - self.origin) * self.scale;
        spread(cell.x as u64) << 2 | spread(cell.y as u64) << 1 | spread(cell.z as u64)
    }

    /// The references in the order of their codes; what has one code stays in the order of its ids.
    pub(crate) fn sort(
        &self,
        references: Vec<Reference>,
        context: &BuildContext,
    ) -> Result<Vec<Reference>, BuildFailure> {
        let count = references.len() as u32;
        let mut codes = context.reserve(references.len())?;
        context.collect_with(&mut codes, count, |_| (), |(), at| (self.code(&references[at as usize]), at));
        context.check()?;
        if context.is_parallel() {
            codes.par_sort_unstable();
        } else {
            codes.sort_unstable();
        }
        context.check()?;
        let mut sorted = context.reserve(references.len())?;
        context.collect_with(&mut sorted, count, |_| (), |(), at| references[codes[at as usize].1 as usize]);
        context.release(codes);
        context.release(references);
        Ok(sorted)
    }

    /// Where the second part begins; `None` where all have one code.
    #[inline(always)]
    fn middle(&self, references: &[Reference]) -> Option<usize> {
        let [first, .., last] = references else { return None };
        let (first, last) = (self.code(first), self.code(last));
        // The highest bit that differs, and all above it, as the last one has them.
        let highest = (first ^ last).checked_ilog2()?;
        let least_right = last >> highest << highest;
        Some(references.partition_point(|reference| self.code(reference) < least_right))
    }
}

/// In `f64`, where it does not overflow.
#[inline(always)]
fn doubled_centre(reference: &Reference) -> DVec3 {
    let corner = |corner: Vec4| corner.truncate().as_dvec3();
    corner(reference.bounds().lower()) - corner(reference.bounds().negated_upper())
}

/// With two zeros before each of the lowest 21 bits.
#[inline(always)]
fn spread(value: u64) -> u64 {
    let mut bits = value & ((1 << BITS) - 1);
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

impl SplitRule for Morton {
    type Scratch = ();

    fn most_in_leaf(&self) -> usize {
        self.most_in_leaf
    }

    #[inline(always)]
    fn split<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        _bounds: &Bounds8,
        _scratch: &mut (),
    ) -> Option<Split> {
        if references.len() <= self.most_in_leaf {
            return None;
        }
        Some(Split::at(simd, self.middle(references)?, references))
    }

    fn split_together(&self, references: &mut [Reference], _bounds: &Bounds8, context: &BuildContext) -> Option<Split> {
        let middle = self.middle(references)?;
        let (left, right) = references.split_at(middle);
        Some(Split { middle, bounds: [union_together(left, context), union_together(right, context)] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_bits_are_three_apart() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread(u64::MAX), 0x1249_2492_4924_9249);
    }

    #[test]
    fn code_of_cells_orders_octants_first() {
        let bounds = Aabb { lower: glam::Vec3::splat(-1.0), upper: glam::Vec3::ONE };
        let rule = Morton::new(&bounds, 4);
        let code = |x: f32, y: f32, z: f32| {
            let at = glam::Vec3::new(x, y, z);
            rule.code(&Reference::new(&Aabb { lower: at, upper: at }, 0, 0))
        };
        assert_eq!(code(-1.0, -1.0, -1.0), 0);
        assert_eq!(code(1.0, 1.0, 1.0), (1 << (3 * BITS)) - 1);
        assert_eq!(code(1.0, -1.0, -1.0), spread((1 << BITS) - 1) << 2);
        assert!(code(-0.1, 0.9, 0.9) < code(0.1, -0.9, -0.9));
    }
}
