//! The lecture's rule: the axes in turn, half of the centres on each side of the median.

use crate::accel::Reference;
use crate::accel::space_tree::Split;
use crate::geometry::Aabb;

const MOST_IN_LEAF: usize = 8;

/// The root has level 1. An axis along which one side would get all is passed over.
pub(super) fn choose(cell: &Aabb, pieces: &[Reference], level: usize) -> Option<Split> {
    if pieces.len() <= MOST_IN_LEAF {
        return None;
    }
    let centre = |piece: &Reference, axis| {
        let (lower, upper) = piece.extent_along(axis);
        // Halves first: a sum could overflow.
        lower * 0.5 + upper * 0.5
    };
    let mut centres = Vec::with_capacity(pieces.len());
    (level - 1..level + 2).map(|turn| turn % 3).find_map(|axis| {
        centres.clear();
        centres.extend(pieces.iter().map(|piece| centre(piece, axis)));
        let middle = centres.len() / 2;
        let position = *centres.select_nth_unstable_by(middle, f32::total_cmp).1;
        if !(cell.lower[axis] < position && position < cell.upper[axis]) {
            return None;
        }
        let split = Split::Fixed { direction: axis as u32, position, is_planar_below: true };
        let below = pieces.iter().filter(|piece| piece.extent_along(axis).0 < position).count();
        let above = pieces.iter().filter(|piece| piece.extent_along(axis).1 > position).count();
        (below.max(above) < pieces.len()).then_some(split)
    })
}
