//! The surface area heuristic over bins of centres.
//!
//! Source: Wald 2007, "On fast construction of SAH-based bounding volume hierarchies", section 3.

use glam::{UVec4, Vec4};

use super::build::{Bounds4, NodeExtent, Reference, SplitRule, reduce_chunks};
use crate::accel::BuildContext;

/// The cost of testing both children of a node.
pub(super) const NODE_COST: f64 = 1.0;
/// The cost of testing one triangle.
pub(super) const TRIANGLE_COST: f64 = 1.0;

const MOST_BINS: usize = 32;

/// Where splitting ends.
pub(crate) struct BinnedSah {
    /// Nodes with more triangles are always split.
    most_in_leaf: usize,
    /// Nodes with no more than these never are; between, the expected cost decides.
    least_split: usize,
}

impl BinnedSah {
    /// Leaves whose triangles are tested one by one.
    pub(crate) const FOR_SCALAR_LEAVES: Self = Self { most_in_leaf: 8, least_split: 1 };
    /// Leaves to be merged into such as are tested at once.
    pub(crate) const FOR_WIDE_LEAVES: Self = Self { most_in_leaf: 4, least_split: 4 };
}

impl SplitRule for BinnedSah {
    fn most_in_leaf(&self) -> usize {
        self.most_in_leaf
    }

    fn split(&self, references: &mut [Reference], extent: &NodeExtent, context: &BuildContext) -> Option<usize> {
        if references.len() <= self.least_split {
            return None;
        }
        let binning = Binning::new(&extent.centres, references.len());
        let bins = reduce_chunks(references, context, |chunk| Bins::of(chunk, &binning), Bins::merge);
        let best = bins.cheapest_plane(&binning)?;
        // Splitting costs a node more, and pays by what the children's boxes leave out.
        let split_cost = NODE_COST as f32 * extent.bounds.half_area() + TRIANGLE_COST as f32 * best.cost;
        let leaf_cost = TRIANGLE_COST as f32 * extent.bounds.half_area() * references.len() as f32;
        // Boxes of no area, or of one beyond f32, make the comparison false: then the leaf's size alone decides.
        if references.len() <= self.most_in_leaf && split_cost.partial_cmp(&leaf_cost) != Some(std::cmp::Ordering::Less)
        {
            return None;
        }
        Some(partition(references, |reference| binning.bins_of(reference)[best.axis] < best.first_right_bin))
    }
}

/// Maps centres to bins.
struct Binning {
    origin: Vec4,
    /// Bins a unit of length; 0 on an axis where all centres are equal.
    scale: Vec4,
    bin_count: usize,
}

impl Binning {
    fn new(centres: &Bounds4, reference_count: usize) -> Self {
        // With few triangles fewer bins tell as much and cost less.
        let bin_count = (4 + reference_count / 2).min(MOST_BINS);
        let extent = (centres.upper - centres.lower).to_array();
        // Just below the count, so that the last centre falls into the last bin.
        let bins = bin_count as f32 * (1.0 - f32::EPSILON);
        let scale = extent.map(|e| bins / e).map(|s| if s.is_finite() { s } else { 0.0 });
        Self { origin: centres.lower, scale: Vec4::from_array(scale), bin_count }
    }

    fn bins_of(&self, reference: &Reference) -> [usize; 3] {
        // A cast from float saturates, and takes a NaN (from an extent beyond f32) for 0.
        let bins: UVec4 = ((reference.centre() - self.origin) * self.scale).as_uvec4();
        let bins = bins.min(UVec4::splat(self.bin_count as u32 - 1));
        [bins.x as usize, bins.y as usize, bins.z as usize]
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds4,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Bounds4::EMPTY, count: 0 };

    fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), count: self.count + other.count }
    }

    /// Area times count; 0 for the empty bin, whose area means nothing.
    fn cost(&self) -> f32 {
        if self.count == 0 { 0.0 } else { self.bounds.half_area() * self.count as f32 }
    }
}

/// A plane between two bins.
struct Plane {
    axis: usize,
    first_right_bin: usize,
    cost: f32,
}

struct Bins {
    axes: [[Bin; MOST_BINS]; 3],
}

impl Bins {
    fn of(references: &[Reference], binning: &Binning) -> Self {
        let mut bins = Self { axes: [[Bin::EMPTY; MOST_BINS]; 3] };
        for reference in references {
            for (axis, at) in binning.bins_of(reference).into_iter().enumerate() {
                let bin = &mut bins.axes[axis][at % MOST_BINS];
                bin.bounds.grow(reference.lower, reference.upper);
                bin.count += 1;
            }
        }
        bins
    }

    fn merge(mut self, other: Self) -> Self {
        for (mine, others) in self.axes.iter_mut().flatten().zip(other.axes.iter().flatten()) {
            *mine = mine.union(*others);
        }
        self
    }

    /// Among the planes with triangles on both sides; `None` where there is none.
    fn cheapest_plane(&self, binning: &Binning) -> Option<Plane> {
        let mut best: Option<Plane> = None;
        for (axis, bins) in self.axes.iter().enumerate() {
            let bins = &bins[..binning.bin_count];
            let mut right_of = [Bin::EMPTY; MOST_BINS];
            let mut right = Bin::EMPTY;
            for at in (1..bins.len()).rev() {
                right = right.union(bins[at]);
                right_of[at] = right;
            }
            let mut left = Bin::EMPTY;
            for first_right_bin in 1..bins.len() {
                left = left.union(bins[first_right_bin - 1]);
                let right = &right_of[first_right_bin];
                if left.count == 0 || right.count == 0 {
                    continue;
                }
                let cost = left.cost() + right.cost();
                if best.as_ref().is_none_or(|best| cost < best.cost) {
                    best = Some(Plane { axis, first_right_bin, cost });
                }
            }
        }
        best
    }
}

/// Moves those that belong to the left before the others; returns how many.
fn partition(references: &mut [Reference], is_left: impl Fn(&Reference) -> bool) -> usize {
    let (mut left, mut right) = (0, references.len());
    loop {
        while left < right && is_left(&references[left]) {
            left += 1;
        }
        while left < right && !is_left(&references[right - 1]) {
            right -= 1;
        }
        if left == right {
            return left;
        }
        references.swap(left, right - 1);
    }
}
