//! The fastest build: references in the order of their centres' Morton codes, split where the highest bit changes that
//! not all have in common.
//!
//! Source: Lauterbach, Garland, Sengupta, Luebke, Manocha 2009, "Fast BVH construction on GPUs", section 3.

use rayon::prelude::*;

use super::build::{Split, SplitRule, union_together};
use crate::accel::morton::{Curve, MOST_BITS};
use crate::accel::reference::{Bounds8, Reference};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::Aabb;
use crate::simd::Simd;

/// Splits references that [`Morton::sort`] has put into their order.
pub(crate) struct Morton {
    curve: Curve,
    most_in_leaf: usize,
}

impl Morton {
    pub(crate) fn new(bounds: &Aabb, most_in_leaf: usize) -> Self {
        Self { curve: Curve::new(bounds, MOST_BITS), most_in_leaf }
    }

    /// The references in the order of their codes; what has one code stays in the order of its ids.
    pub(crate) fn sort(
        &self,
        references: Vec<Reference>,
        context: &BuildContext,
    ) -> Result<Vec<Reference>, BuildFailure> {
        let count = references.len() as u32;
        let mut codes = context.reserve(references.len())?;
        context.collect_with(&mut codes, count, |_| (), |(), at| (self.curve.code(&references[at as usize]), at));
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
        let (first, last) = (self.curve.code(first), self.curve.code(last));
        // The highest bit that differs, and all above it, as the last one has them.
        let highest = (first ^ last).checked_ilog2()?;
        let least_right = last >> highest << highest;
        Some(references.partition_point(|reference| self.curve.code(reference) < least_right))
    }
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
