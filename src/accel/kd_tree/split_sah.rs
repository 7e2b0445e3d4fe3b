//! The surface area heuristic: exact for small cells, over bins of bounds for large ones.
//!
//! Sources: Wald and Havran 2006, "On building fast kd-trees for ray tracing, and on doing that in O(N log N)"; for the
//! bins Shevtsov, Soupikov, Kapustin 2007, "Highly parallel fast kd-tree construction for interactive ray tracing".

use super::half_area;
use crate::accel::Reference;
use crate::accel::space_tree::{Split, split_cost};
use crate::geometry::Aabb;

/// In steps down. Measured: 0.3 to 2 on a scan, a board, an engine, a house and a soup; the least makes the fastest rays and
/// builds, because a step waits for the one before and most primitives are refused early.
pub(super) const PRIMITIVE_COST: f64 = 0.3;

/// Larger cells are binned.
const MOST_SWEPT: usize = 128;

const BIN_COUNT: usize = 64;

/// Room for the bounds along one axis, or for bins.
#[derive(Default)]
pub(super) struct Sah {
    lowers: Vec<f32>,
    uppers: Vec<f32>,
    /// Of pieces that lie in a plane across the axis.
    planars: Vec<f32>,
}

/// The best plane so far.
struct Best {
    cost: f64,
    split: Option<Split>,
}

/// Rates planes across one axis.
struct Rating<'a> {
    axis: usize,
    lower: f32,
    upper: f32,
    /// Half the surface of both ends together, as a share of the whole's.
    ends: f64,
    /// What is beside them, per length.
    sides: f64,
    best: &'a mut Best,
}

impl Rating<'_> {
    fn new<'a>(cell: &Aabb, axis: usize, best: &'a mut Best) -> Rating<'a> {
        let size = cell.upper.as_dvec3() - cell.lower.as_dvec3();
        let mut end = size;
        end[axis] = 0.0;
        let (end, whole) = (half_area(end), half_area(size));
        Rating {
            axis,
            lower: cell.lower[axis],
            upper: cell.upper[axis],
            ends: end / whole,
            sides: (whole - end) / whole / size[axis],
            best,
        }
    }

    #[inline(always)]
    fn rate(&mut self, position: f32, below: usize, above: usize, is_planar_below: bool) {
        if !(self.lower < position && position < self.upper) {
            return;
        }
        let share = |length: f64| self.ends + self.sides * length;
        let (to_lower, to_upper) =
            (f64::from(position) - f64::from(self.lower), f64::from(self.upper) - f64::from(position));
        let cost = split_cost([share(to_lower), share(to_upper)], [below, above], PRIMITIVE_COST);
        if cost < self.best.cost {
            let split = Split::Fixed { direction: self.axis as u32, position, is_planar_below };
            *self.best = Best { cost, split: Some(split) };
        }
    }
}

impl Sah {
    /// The cheapest plane, if it is cheaper than a leaf.
    pub(super) fn choose(&mut self, cell: &Aabb, pieces: &[Reference]) -> Option<Split> {
        let mut best = Best { cost: PRIMITIVE_COST * pieces.len() as f64, split: None };
        for axis in 0..3 {
            if cell.lower[axis] < cell.upper[axis] {
                let mut rating = Rating::new(cell, axis, &mut best);
                if pieces.len() <= MOST_SWEPT {
                    self.sweep(pieces, &mut rating);
                } else {
                    bin(pieces, &mut rating);
                }
            }
        }
        best.split
    }

    /// Every bound is a candidate.
    fn sweep(&mut self, pieces: &[Reference], rating: &mut Rating) {
        let Self { lowers, uppers, planars } = self;
        lowers.clear();
        uppers.clear();
        planars.clear();
        for piece in pieces {
            let (lower, upper) = piece.extent_along(rating.axis);
            if lower == upper {
                planars.push(lower);
            } else {
                lowers.push(lower);
                uppers.push(upper);
            }
        }
        for values in [&mut *lowers, &mut *uppers, &mut *planars] {
            values.sort_unstable_by(f32::total_cmp);
        }
        // How many of each are at or below the last candidate.
        let (mut begun, mut ended, mut passed) = (0, 0, 0);
        loop {
            let next = |values: &[f32], at: usize| values.get(at).copied().unwrap_or(f32::INFINITY);
            let position = next(lowers, begun).min(next(uppers, ended)).min(next(planars, passed));
            if position == f32::INFINITY {
                return;
            }
            let passed_before = passed;
            while next(uppers, ended) == position {
                ended += 1;
            }
            while next(planars, passed) == position {
                passed += 1;
            }
            let (below, above) = (begun + passed_before, pieces.len() - ended - passed);
            let here = passed - passed_before;
            rating.rate(position, below + here, above, true);
            if here != 0 {
                rating.rate(position, below, above + here, false);
            }
            while next(lowers, begun) == position {
                begun += 1;
            }
        }
    }
}

/// The candidates are the planes between bins of equal width, and the ends of all pieces.
fn bin(pieces: &[Reference], rating: &mut Rating) {
    let axis = rating.axis;
    let (lower, upper) = pieces
        .iter()
        .map(|piece| piece.extent_along(axis))
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(lower, upper), (low, high)| (lower.min(low), upper.max(high)));
    let size = f64::from(upper) - f64::from(lower);
    rating.rate(lower, 0, pieces.len(), false);
    rating.rate(upper, pieces.len(), 0, true);
    // Refuses, too, what has no inverse.
    let scale = (BIN_COUNT as f64 / size) as f32;
    if !(0.0 < scale && scale < f32::INFINITY) {
        return;
    }
    let mut begun = [0; BIN_COUNT];
    let mut ended = [0; BIN_COUNT];
    let bin_of = |value: f32| (((value - lower) * scale) as usize).min(BIN_COUNT - 1);
    for piece in pieces {
        let (low, high) = piece.extent_along(axis);
        begun[bin_of(low)] += 1;
        ended[bin_of(high)] += 1;
    }
    let (mut below, mut above) = (0, pieces.len());
    for at in 1..BIN_COUNT {
        below += begun[at - 1];
        above -= ended[at - 1];
        let position = (f64::from(lower) + size * (at as f64 / BIN_COUNT as f64)) as f32;
        rating.rate(position, below, above, true);
    }
}
