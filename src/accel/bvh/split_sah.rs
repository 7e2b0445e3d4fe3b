//! The surface area heuristic over bins of centres.
//!
//! Source: Wald 2007, "On fast construction of SAH-based bounding volume hierarchies", section 3.

use glam::Vec4;

use super::build::{Split, SplitRule};
use super::node::Node;
use crate::accel::BuildContext;
use crate::accel::build_context::CHUNK;
use crate::accel::reference::{Bounds8, Reference};
use crate::simd::{Scalar, Simd, SimdKernel};

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
    /// At most [`MOST_BINS`].
    bin_count: usize,
    /// What a leaf of so many triangles costs a ray that meets it.
    leaf_cost: fn(u32) -> f64,
}

impl BinnedSah {
    /// Leaves whose triangles are tested one by one.
    pub(crate) const FOR_SCALAR_LEAVES: Self = Self {
        most_in_leaf: 8,
        least_split: 1,
        bin_count: MOST_BINS,
        leaf_cost: |count| f64::from(count) * TRIANGLE_COST,
    };
    /// Leaves to be merged into such as are tested at once.
    pub(crate) const FOR_WIDE_LEAVES: Self =
        Self { most_in_leaf: 4, least_split: 4, bin_count: MOST_BINS, leaf_cost: |_| TRIANGLE_COST };

    /// The cheapest plane, if a split there is worth it.
    #[inline(always)]
    fn choose<S: Simd>(
        &self,
        simd: S,
        bins: &mut Bins,
        binning: &Binning,
        bounds: &Bounds8,
        count: usize,
    ) -> Option<Plane> {
        let area = Area::within(bounds);
        let best = bins.cheapest_plane(simd, binning, &area)?;
        // Splitting costs a node more, and pays by what the children's boxes leave out.
        let split_cost = NODE_COST as f32 * area.of(bounds) + TRIANGLE_COST as f32 * best.cost;
        let leaf_cost = TRIANGLE_COST as f32 * area.of(bounds) * count as f32;
        (count > self.most_in_leaf || split_cost < leaf_cost).then_some(best)
    }
}

/// The cheapest plane, if a split there is worth it, and the boxes of both sides.
pub(super) struct ObjectSplit {
    binning: Binning,
    plane: Plane,
    pub(super) bounds: [Bounds8; 2],
}

impl ObjectSplit {
    /// Areas of both sides times their numbers of triangles.
    #[inline(always)]
    pub(super) fn cost(&self) -> f32 {
        self.plane.cost
    }

    #[inline(always)]
    pub(super) fn make(self, references: &mut [Reference]) -> Split {
        Split { middle: partition(references, &self.binning, &self.plane), bounds: self.bounds }
    }

    /// As [`ObjectSplit::make`], on all threads.
    pub(super) fn make_together(self, references: &mut [Reference], context: &BuildContext) -> Split {
        let part = |chunk: &mut [Reference]| {
            context.vectorize(Partition { references: chunk, binning: &self.binning, plane: &self.plane })
        };
        let middles = context.map_chunks(references, part);
        Split { middle: join_partitions(references, &middles, context), bounds: self.bounds }
    }
}

impl BinnedSah {
    /// Of a ray that meets the leaf's parent.
    pub(super) fn cost_of_leaf(&self, leaf: &Node) -> f64 {
        leaf.half_area() * (self.leaf_cost)(leaf.count)
    }

    #[inline(always)]
    pub(super) fn find<S: Simd>(
        &self,
        simd: S,
        references: &[Reference],
        bounds: &Bounds8,
        bins: &mut Bins,
    ) -> Option<ObjectSplit> {
        if references.len() <= self.least_split {
            return None;
        }
        let binning = Binning::new(&centres(references), references.len(), self.bin_count);
        bins.fill(simd, references, &binning);
        let plane = self.choose(simd, bins, &binning, bounds, references.len())?;
        let bounds = bins.unions(simd, &binning, &plane);
        Some(ObjectSplit { binning, plane, bounds })
    }

    /// As [`BinnedSah::find`], on all threads.
    pub(super) fn find_together(
        &self,
        references: &[Reference],
        bounds: &Bounds8,
        context: &BuildContext,
    ) -> Option<ObjectSplit> {
        let centres = |chunk: &[Reference]| context.vectorize(Centres(chunk));
        let centres = context.reduce_chunks(references, centres, |a, b| a.union(Scalar, &b))?;
        let binning = Binning::new(&centres, references.len(), self.bin_count);
        let fill = |chunk: &[Reference]| context.vectorize(Fill { references: chunk, binning: &binning });
        let mut bins = context.reduce_chunks(references, fill, Bins::merge)?;
        let plane = self.choose(Scalar, &mut bins, &binning, bounds, references.len())?;
        let bounds = bins.unions(Scalar, &binning, &plane);
        Some(ObjectSplit { binning, plane, bounds })
    }
}

impl SplitRule for BinnedSah {
    type Scratch = Bins;

    fn most_in_leaf(&self) -> usize {
        self.most_in_leaf
    }

    #[inline(always)]
    fn split<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        bounds: &Bounds8,
        bins: &mut Bins,
    ) -> Option<Split> {
        let split = self.find(simd, references, bounds, bins)?;
        Some(split.make(references))
    }

    fn split_together(&self, references: &mut [Reference], bounds: &Bounds8, context: &BuildContext) -> Option<Split> {
        let split = self.find_together(references, bounds, context)?;
        Some(split.make_together(references, context))
    }
}

/// The box of the centres, doubled.
#[inline(always)]
fn centres(references: &[Reference]) -> Bounds8 {
    let (mut lower, mut upper) = (Vec4::INFINITY, Vec4::NEG_INFINITY);
    for reference in references {
        let centre = reference.bounds().doubled_centre();
        lower = lower.min(centre);
        upper = upper.max(centre);
    }
    Bounds8::from_corners(lower, upper)
}

struct Centres<'a>(&'a [Reference]);

impl SimdKernel for Centres<'_> {
    type Output = Bounds8;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> Bounds8 {
        centres(self.0)
    }
}

struct Fill<'a> {
    references: &'a [Reference],
    binning: &'a Binning,
}

impl SimdKernel for Fill<'_> {
    type Output = Box<Bins>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Box<Bins> {
        let mut bins = Box::<Bins>::default();
        bins.fill(simd, self.references, self.binning);
        bins
    }
}

struct Partition<'a> {
    references: &'a mut [Reference],
    binning: &'a Binning,
    plane: &'a Plane,
}

impl SimdKernel for Partition<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> usize {
        partition(self.references, self.binning, self.plane)
    }
}

/// Maps centres to bins.
struct Binning {
    origin: Vec4,
    /// Bins a unit of length; 0 on an axis where all centres are equal.
    scale: Vec4,
    last: Vec4,
    bin_count: usize,
}

/// Added to a small float, rounds it to a whole number, which then stands in the lowest bits.
const ROUNDER: f32 = (1 << 23) as f32;

impl Binning {
    #[inline(always)]
    fn new(doubled_centres: &Bounds8, reference_count: usize, most_bins: usize) -> Self {
        // With few triangles fewer bins tell as much and cost less.
        let bin_count = (4 + reference_count / 8).min(most_bins);
        let extent = doubled_centres.size();
        let scale = Vec4::splat(bin_count as f32) / extent;
        // Also refuses an extent beyond f32.
        let is_usable = extent.cmpgt(Vec4::ZERO) & scale.cmplt(Vec4::INFINITY) & scale.cmpgt(Vec4::ZERO);
        let scale = Vec4::select(is_usable, scale, Vec4::ZERO);
        // Half a bin later, for what is cut off then is what rounding takes.
        let half_bin = Vec4::select(is_usable, extent * (0.5 / bin_count as f32), Vec4::ZERO);
        let origin = doubled_centres.lower() + half_bin;
        Self { origin, scale, last: Vec4::splat((bin_count - 1) as f32), bin_count }
    }

    /// A bin's number, plus [`ROUNDER`].
    #[inline(always)]
    fn bins_of(&self, reference: &Reference) -> Vec4 {
        let bin = (reference.bounds().doubled_centre() - self.origin) * self.scale;
        // A NaN, from a centre beyond f32, becomes one of both.
        bin.max(Vec4::ZERO).min(self.last) + Vec4::splat(ROUNDER)
    }

    /// As [`Binning::bins_of`], on one axis.
    #[inline(always)]
    fn bin_of(&self, reference: &Reference, axis: usize) -> f32 {
        self.bins_of(reference)[axis]
    }
}

/// Half the surface of boxes within one, in units that neither overflow nor vanish.
pub(super) struct Area {
    scale: Vec4,
}

impl Area {
    #[inline(always)]
    pub(super) fn within(bounds: &Bounds8) -> Self {
        let largest = bounds.size().truncate().max_element();
        Self { scale: Vec4::splat((1.0 / largest).min(f32::MAX)) }
    }

    /// A little more, so that of boxes in a plane the shorter one and of those on a line the shortest has the least.
    #[inline(always)]
    pub(super) fn of(&self, bounds: &Bounds8) -> f32 {
        const LEAST: f32 = 1.0 / (1 << 20) as f32;
        let [x, y, z, _] = (bounds.size() * self.scale).max(Vec4::splat(LEAST)).to_array();
        x * y + y * z + z * x
    }
}

/// A plane between two bins.
struct Plane {
    axis: usize,
    first_right_bin: usize,
    cost: f32,
}

/// For each bin, by axis, the box of its triangles and their number.
struct BinSet {
    bounds: [[Bounds8; 3]; MOST_BINS],
    counts: [[u32; 4]; MOST_BINS],
}

impl BinSet {
    const EMPTY: Self = Self { bounds: [[Bounds8::EMPTY; 3]; MOST_BINS], counts: [[0; 4]; MOST_BINS] };

    #[inline(always)]
    fn clear(&mut self, bin_count: usize) {
        for bin in &mut self.bounds[..bin_count] {
            *bin = [Bounds8::EMPTY; 3];
        }
        for count in &mut self.counts[..bin_count] {
            *count = [0; 4];
        }
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, reference: &Reference, binning: &Binning) {
        let [x, y, z, _] = binning.bins_of(reference).to_array();
        self.add_on_axis(simd, reference, x, 0);
        self.add_on_axis(simd, reference, y, 1);
        self.add_on_axis(simd, reference, z, 2);
    }

    #[inline(always)]
    fn add_on_axis<S: Simd>(&mut self, simd: S, reference: &Reference, bin: f32, axis: usize) {
        let at = bin.to_bits() as usize % MOST_BINS;
        self.bounds[at][axis].grow(simd, reference.bounds());
        self.counts[at][axis] += 1;
    }

    #[inline(always)]
    fn merge<S: Simd>(&mut self, simd: S, other: &Self, bin_count: usize) {
        for (mine, others) in self.bounds[..bin_count].iter_mut().zip(&other.bounds) {
            mine[0].grow(simd, &others[0]);
            mine[1].grow(simd, &others[1]);
            mine[2].grow(simd, &others[2]);
        }
        for (mine, others) in self.counts[..bin_count].as_flattened_mut().iter_mut().zip(other.counts.as_flattened()) {
            *mine += others;
        }
    }
}

/// Neighbours in memory often fall into the same bin, where one would wait for the other: they go into two sets.
pub(crate) struct Bins {
    sets: [BinSet; 2],
    /// What the right side costs where a bin is its first one.
    right_costs: [Vec4; MOST_BINS],
}

impl Default for Bins {
    fn default() -> Self {
        Self { sets: [BinSet::EMPTY; 2], right_costs: [Vec4::ZERO; MOST_BINS] }
    }
}

impl Bins {
    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, references: &[Reference], binning: &Binning) {
        /// Fewer are not worth a second set.
        const LEAST_FOR_TWO: usize = 32;
        let bin_count = binning.bin_count.min(MOST_BINS);
        let [first, second] = &mut self.sets;
        first.clear(bin_count);
        if references.len() < LEAST_FOR_TWO {
            for reference in references {
                first.add(simd, reference, binning);
            }
            return;
        }
        second.clear(bin_count);
        let (pairs, last) = references.as_chunks::<2>();
        for [a, b] in pairs {
            first.add(simd, a, binning);
            second.add(simd, b, binning);
        }
        for reference in last {
            first.add(simd, reference, binning);
        }
        first.merge(simd, second, bin_count);
    }

    fn merge(mut self: Box<Self>, other: Box<Self>) -> Box<Self> {
        self.sets[0].merge(Scalar, &other.sets[0], MOST_BINS);
        self
    }

    /// Among the planes with triangles on both sides; `None` where there is none.
    #[inline(always)]
    fn cheapest_plane<S: Simd>(&mut self, simd: S, binning: &Binning, area: &Area) -> Option<Plane> {
        let bin_count = binning.bin_count.min(MOST_BINS);
        let mut side = Side::EMPTY;
        for at in (1..bin_count).rev() {
            side.add(simd, &self.sets[0].bounds[at], &self.sets[0].counts[at]);
            self.right_costs[at] = side.cost(area);
        }
        let (mut costs, mut planes) = (Vec4::INFINITY, Vec4::ZERO);
        let mut side = Side::EMPTY;
        for at in 1..bin_count {
            side.add(simd, &self.sets[0].bounds[at - 1], &self.sets[0].counts[at - 1]);
            let cost = side.cost(area) + self.right_costs[at];
            let is_better = cost.cmplt(costs);
            costs = Vec4::select(is_better, cost, costs);
            planes = Vec4::select(is_better, Vec4::splat(at as f32), planes);
        }
        let ([x, y, z, _], planes) = (costs.to_array(), planes.to_array());
        let (axis, cost) = if x <= y && x <= z {
            (0, x)
        } else if y <= z {
            (1, y)
        } else {
            (2, z)
        };
        (cost < f32::INFINITY).then_some(Plane { axis, first_right_bin: planes[axis] as usize, cost })
    }

    /// The boxes of both sides of a plane.
    #[inline(always)]
    fn unions<S: Simd>(&self, simd: S, binning: &Binning, plane: &Plane) -> [Bounds8; 2] {
        let mut bounds = [Bounds8::EMPTY; 2];
        for at in 0..binning.bin_count.min(MOST_BINS) {
            bounds[usize::from(at >= plane.first_right_bin)].grow(simd, &self.sets[0].bounds[at][plane.axis]);
        }
        bounds
    }
}

/// What lies on one side of a plane, by axis.
struct Side {
    bounds: [Bounds8; 3],
    counts: [u32; 4],
}

impl Side {
    const EMPTY: Self = Self { bounds: [Bounds8::EMPTY; 3], counts: [0; 4] };

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, bounds: &[Bounds8; 3], counts: &[u32; 4]) {
        self.bounds[0].grow(simd, &bounds[0]);
        self.bounds[1].grow(simd, &bounds[1]);
        self.bounds[2].grow(simd, &bounds[2]);
        for (mine, others) in self.counts.iter_mut().zip(counts) {
            *mine += others;
        }
    }

    /// Area times count; infinite where nothing is there.
    #[inline(always)]
    fn cost(&self, area: &Area) -> Vec4 {
        let areas = Vec4::new(area.of(&self.bounds[0]), area.of(&self.bounds[1]), area.of(&self.bounds[2]), 0.0);
        let [x, y, z, w] = self.counts;
        let counts = Vec4::new(x as i32 as f32, y as i32 as f32, z as i32 as f32, w as i32 as f32);
        Vec4::select(counts.cmpeq(Vec4::ZERO), Vec4::INFINITY, areas * counts)
    }
}

/// Moves those that belong to the left before the others; returns how many. Without a branch on the references, which no
/// CPU could foresee.
#[inline(always)]
fn partition(references: &mut [Reference], binning: &Binning, plane: &Plane) -> usize {
    let first_right = ROUNDER + plane.first_right_bin as f32;
    let mut left = 0;
    for at in 0..references.len() {
        let is_left = binning.bin_of(&references[at], plane.axis) < first_right;
        references.swap(at, left);
        left += usize::from(is_left);
    }
    left
}

/// Makes one partition of those of all chunks, given each one's middle: exchanges what stands on the wrong side of the
/// whole's middle, which is returned.
fn join_partitions(references: &mut [Reference], middles: &[usize], context: &BuildContext) -> usize {
    let middle = middles.iter().sum();
    let (left, right) = references.split_at_mut(middle);
    // The chunk that the middle is in has a part on either side.
    let (first, offset) = (middle / CHUNK, middle % CHUNK);
    let (head, tail) = right.split_at_mut(right.len().min(CHUNK - offset));
    let head_middle = middles.get(first).map_or(0, |middle| middle.saturating_sub(offset));
    let wrong_left = left.chunks_mut(CHUNK).zip(middles).map(|(chunk, &middle)| {
        let at = middle.min(chunk.len());
        &mut chunk[at..]
    });
    let wrong_right = std::iter::once(&mut head[..head_middle]).chain(
        tail.chunks_mut(CHUNK)
            .zip(&middles[middles.len().min(first + 1)..])
            .map(|(chunk, &middle)| &mut chunk[..middle]),
    );
    let mut exchanges = Vec::new();
    let mut wrong_right = wrong_right.filter(|run| !run.is_empty());
    let mut there: &mut [Reference] = &mut [];
    for mut here in wrong_left {
        while !here.is_empty() {
            if there.is_empty() {
                there = wrong_right.next().expect("as many stand wrong on the right as on the left");
            }
            let count = here.len().min(there.len());
            let (run_here, rest_here) = here.split_at_mut(count);
            let (run_there, rest_there) = std::mem::take(&mut there).split_at_mut(count);
            exchanges.push((run_here, run_there));
            (here, there) = (rest_here, rest_there);
        }
    }
    context.map_each(exchanges, |(here, there)| here.swap_with_slice(there));
    middle
}
