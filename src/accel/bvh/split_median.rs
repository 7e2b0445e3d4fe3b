//! The lecture's rule: along the longest axis of the node's box, half of the triangles on each side of the median.

use super::build::{NodeExtent, Reference, SplitRule};
use crate::accel::BuildContext;

pub(crate) struct Median;

impl SplitRule for Median {
    fn most_in_leaf(&self) -> usize {
        5
    }

    fn split(&self, references: &mut [Reference], extent: &NodeExtent, _context: &BuildContext) -> Option<usize> {
        if references.len() <= self.most_in_leaf() {
            return None;
        }
        let axis = (extent.bounds.upper - extent.bounds.lower).truncate().max_position();
        let middle = references.len() / 2;
        references.select_nth_unstable_by(middle, |a, b| {
            a.centre()[axis].total_cmp(&b.centre()[axis]).then_with(|| a.index().cmp(&b.index()))
        });
        Some(middle)
    }
}
