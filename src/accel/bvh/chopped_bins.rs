//! Bins of space, for planes that may cut triangles: each has the boxes of what of the triangles is in it.
//!
//! Source: Stich, Friedrich, Dietrich 2009, "Spatial splits in bounding volume hierarchies", section 3.2.

use glam::Vec4;

use super::clip::chop;
use super::split_sah::Area;
use crate::accel::Primitive;
use crate::accel::reference::{Bounds8, PrimitiveSource, Reference};
use crate::simd::{Scalar, Simd, SimdKernel};

pub(super) const MOST_BINS: usize = 16;

/// Slabs of one width along each axis.
#[derive(Clone, Copy)]
pub(super) struct Slabs {
    origin: Vec4,
    width: Vec4,
    /// Slabs a unit of length; 0 on an axis that is not divided.
    scale: Vec4,
    count: usize,
}

/// Added to a small float, rounds it to a whole number, which then stands in the lowest bits.
const ROUNDER: f32 = (1 << 23) as f32;

impl Slabs {
    #[inline(always)]
    pub(super) fn new(bounds: &Bounds8, reference_count: usize) -> Self {
        // With few triangles fewer tell as much and cost less.
        let count = (4 + reference_count / 4).min(MOST_BINS);
        let extent = bounds.size();
        let scale = Vec4::splat(count as f32) / extent;
        // Also refuses an extent beyond f32.
        let is_usable = extent.cmpgt(Vec4::ZERO) & scale.cmplt(Vec4::INFINITY) & scale.cmpgt(Vec4::ZERO);
        let scale = Vec4::select(is_usable, scale, Vec4::ZERO);
        Self { origin: bounds.lower(), width: extent / count as f32, scale, count }
    }

    /// The slabs that a point is in, by axis.
    #[inline(always)]
    pub(super) fn of(&self, point: Vec4) -> [usize; 4] {
        // Half a slab less, for rounding takes half a slab more.
        let slab = (point - self.origin) * self.scale - Vec4::splat(0.5);
        let last = Vec4::splat((self.count - 1) as f32);
        let rounded = slab.max(Vec4::ZERO).min(last) + Vec4::splat(ROUNDER);
        rounded.to_array().map(|slab| slab.to_bits() as usize % MOST_BINS)
    }

    /// Where a slab begins.
    #[inline(always)]
    pub(super) fn plane(&self, axis: usize, slab: usize) -> f32 {
        self.origin[axis] + self.width[axis] * slab as f32
    }
}

/// A plane between two slabs, and what is on either side where it cuts all triangles that it meets.
pub(super) struct CuttingPlane {
    pub(super) axis: usize,
    pub(super) position: f32,
    pub(super) cost: f32,
    pub(super) bounds: [Bounds8; 2],
    pub(super) counts: [u32; 2],
}

/// By axis and slab: the box of what is in it, how many triangles begin in it, and how many end.
pub(super) struct ChoppedBins {
    bounds: [[Bounds8; MOST_BINS]; 3],
    entries: [[u32; MOST_BINS]; 3],
    exits: [[u32; MOST_BINS]; 3],
}

impl Default for ChoppedBins {
    fn default() -> Self {
        Self { bounds: [[Bounds8::EMPTY; MOST_BINS]; 3], entries: [[0; MOST_BINS]; 3], exits: [[0; MOST_BINS]; 3] }
    }
}

impl ChoppedBins {
    #[inline(always)]
    pub(super) fn fill<S: Simd>(
        &mut self,
        simd: S,
        references: &[Reference],
        slabs: &Slabs,
        source: &impl PrimitiveSource,
    ) {
        let count = slabs.count.min(MOST_BINS);
        for axis in 0..3 {
            self.bounds[axis][..count].fill(Bounds8::EMPTY);
            self.entries[axis][..count].fill(0);
            self.exits[axis][..count].fill(0);
        }
        let mut parts = [Bounds8::EMPTY; MOST_BINS];
        for reference in references {
            let bounds = reference.bounds();
            let (first, last) = (slabs.of(bounds.lower()), slabs.of(-bounds.negated_upper()));
            let mut triangle = None;
            for axis in 0..3 {
                let (first, last) = (first[axis], last[axis]);
                self.entries[axis][first] += 1;
                self.exits[axis][last] += 1;
                if first == last {
                    self.bounds[axis][first].grow(simd, bounds);
                    continue;
                }
                let triangle = triangle
                    .get_or_insert_with(|| reference.primitive(source).as_triangle().expect("nothing else is cut"));
                chop(simd, triangle, axis, slabs, [first, last], &mut parts);
                for (bin, part) in self.bounds[axis][first..=last].iter_mut().zip(&parts[first..=last]) {
                    bin.grow(simd, &part.intersection(simd, bounds));
                }
            }
        }
    }

    pub(super) fn merge(mut self: Box<Self>, other: Box<Self>) -> Box<Self> {
        for axis in 0..3 {
            for slab in 0..MOST_BINS {
                self.bounds[axis][slab].grow(Scalar, &other.bounds[axis][slab]);
                self.entries[axis][slab] += other.entries[axis][slab];
                self.exits[axis][slab] += other.exits[axis][slab];
            }
        }
        self
    }

    /// Among the planes with triangles on both sides; `None` where there is none.
    #[inline(always)]
    pub(super) fn cheapest_plane<S: Simd>(&self, simd: S, slabs: &Slabs, area: &Area) -> Option<CuttingPlane> {
        let mut best: Option<CuttingPlane> = None;
        for axis in 0..3 {
            let (bounds, entries, exits) = (&self.bounds[axis], &self.entries[axis], &self.exits[axis]);
            let slab_count = slabs.count.min(MOST_BINS);
            let mut rights = [(Bounds8::EMPTY, 0); MOST_BINS];
            let (mut right, mut right_count) = (Bounds8::EMPTY, 0);
            for slab in (1..slab_count).rev() {
                right.grow(simd, &bounds[slab]);
                right_count += exits[slab];
                rights[slab] = (right, right_count);
            }
            let (mut left, mut left_count) = (Bounds8::EMPTY, 0);
            for slab in 1..slab_count {
                left.grow(simd, &bounds[slab - 1]);
                left_count += entries[slab - 1];
                let (right, right_count) = rights[slab];
                if left_count == 0 || right_count == 0 {
                    continue;
                }
                let cost = area.of(&left) * left_count as f32 + area.of(&right) * right_count as f32;
                if best.as_ref().is_none_or(|best| cost < best.cost) {
                    let position = slabs.plane(axis, slab);
                    let (bounds, counts) = ([left, right], [left_count, right_count]);
                    best = Some(CuttingPlane { axis, position, cost, bounds, counts });
                }
            }
        }
        best
    }
}

/// Fills the bins with a chunk of the references.
pub(super) struct Fill<'a, T> {
    pub(super) references: &'a [Reference],
    pub(super) slabs: &'a Slabs,
    pub(super) source: &'a T,
}

impl<T: PrimitiveSource> SimdKernel for Fill<'_, T> {
    type Output = Box<ChoppedBins>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Box<ChoppedBins> {
        let mut bins = Box::<ChoppedBins>::default();
        bins.fill(simd, self.references, self.slabs, self.source);
        bins
    }
}
