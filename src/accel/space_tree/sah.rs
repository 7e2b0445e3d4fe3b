//! The surface area heuristic for cells (MacDonald and Booth 1990).

/// The cost of a step down.
pub(in crate::accel) const NODE_COST: f64 = 1.0;

/// What a plane costs, in its share, that cuts off empty space (Wald and Havran 2006, section 3.3).
const EMPTY_DISCOUNT: f64 = 0.65;

/// Only where what is left has no more than this share of the surface: else planes would shave cells, level by level.
const MOST_LEFT: f64 = 0.9;

/// What a ray through a cell costs that is divided: `shares` are those of the parts in the cell's surface.
#[inline(always)]
pub(in crate::accel) fn split_cost(shares: [f64; 2], counts: [usize; 2], primitive_cost: f64) -> f64 {
    let is_worth_it = (counts[0] == 0 && shares[1] <= MOST_LEFT) || (counts[1] == 0 && shares[0] <= MOST_LEFT);
    let discount = if is_worth_it { EMPTY_DISCOUNT } else { 1.0 };
    discount * (NODE_COST + primitive_cost * (shares[0] * counts[0] as f64 + shares[1] * counts[1] as f64))
}
