//! The lecture's rule: along the longest axis of the node's box, half of the triangles on each side of the median.

use super::build::{Split, SplitRule};
use crate::accel::BuildContext;
use crate::accel::reference::{Bounds8, Reference};
use crate::simd::{Simd, SimdKernel};

pub(crate) struct Median;

impl SplitRule for Median {
    type Scratch = ();

    fn most_in_leaf(&self) -> usize {
        5
    }

    #[inline(always)]
    fn split<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        bounds: &Bounds8,
        _scratch: &mut (),
    ) -> Option<Split> {
        if references.len() <= self.most_in_leaf() {
            return None;
        }
        let axis = bounds.size().truncate().max_position();
        let middle = references.len() / 2;
        references.select_nth_unstable_by(middle, |a, b| {
            let centre = |reference: &Reference| reference.bounds().doubled_centre()[axis];
            centre(a).total_cmp(&centre(b)).then_with(|| a.ids().cmp(&b.ids()))
        });
        Some(Split::at(simd, middle, references))
    }

    fn split_together(&self, references: &mut [Reference], bounds: &Bounds8, context: &BuildContext) -> Option<Split> {
        context.vectorize(SplitAlone { references, bounds })
    }
}

struct SplitAlone<'a> {
    references: &'a mut [Reference],
    bounds: &'a Bounds8,
}

impl SimdKernel for SplitAlone<'_> {
    type Output = Option<Split>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Option<Split> {
        Median.split(simd, self.references, self.bounds, &mut ())
    }
}
