//! What a builder sorts in place of primitives: their boxes, with the ids to find them again.

use glam::Vec4;
use rayon::prelude::*;

use super::{BuildContext, BuildFailure, Primitive};
use crate::geometry::{Aabb, Triangle};
use crate::simd::Simd;

/// Where the primitives are that references speak of.
pub(crate) trait PrimitiveSource: Sync {
    type Primitive: Primitive;

    fn primitive(&self, geometry_id: u32, primitive_id: u32) -> Self::Primitive;

    /// For each geometry the number of primitives in those before it; then that of all.
    fn starts(&self) -> &[u32];
}

/// Has triangles.
pub(crate) trait TriangleSource: PrimitiveSource<Primitive = Triangle> {}

impl<S: PrimitiveSource<Primitive = Triangle>> TriangleSource for S {}

/// A box as eight lanes: the lower corner, a lane to spare, the negated upper corner, a lane to spare. One minimum
/// makes the union of two. 32 bytes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Bounds8(pub(super) [f32; 8]);

impl Bounds8 {
    pub(crate) const EMPTY: Self = Self([f32::INFINITY; 8]);

    #[inline(always)]
    pub(super) fn from_corners(lower: Vec4, upper: Vec4) -> Self {
        let ([a, b, c, d], [x, y, z, w]) = (lower.to_array(), (-upper).to_array());
        Self([a, b, c, d, x, y, z, w])
    }

    #[inline(always)]
    pub(crate) fn to_aabb(self) -> Aabb {
        Aabb { lower: self.lower().truncate(), upper: -self.negated_upper().truncate() }
    }

    #[inline(always)]
    pub(super) fn lower(&self) -> Vec4 {
        Vec4::new(self.0[0], self.0[1], self.0[2], self.0[3])
    }

    #[inline(always)]
    pub(super) fn negated_upper(&self) -> Vec4 {
        Vec4::new(self.0[4], self.0[5], self.0[6], self.0[7])
    }

    /// Negative where the box is empty. The fourth is 0: ids make denormal numbers, and CPUs take a hundred times as
    /// long to multiply one.
    #[inline(always)]
    pub(super) fn size(&self) -> Vec4 {
        (-(self.lower() + self.negated_upper())).with_w(0.0)
    }

    /// The fourth is 0, as of [`Bounds8::size`].
    #[inline(always)]
    pub(super) fn doubled_centre(&self) -> Vec4 {
        (self.lower() - self.negated_upper()).with_w(0.0)
    }

    pub(super) fn union<S: Simd>(mut self, simd: S, other: &Self) -> Self {
        self.grow(simd, other);
        self
    }

    /// What the spare lanes hold has no meaning. Some upper plane is below its lower one where nothing is common.
    #[inline(always)]
    pub(super) fn intersection<S: Simd>(mut self, simd: S, other: &Self) -> Self {
        self.0 = simd.store(simd.max(simd.load(&self.0), simd.load(&other.0)));
        self
    }

    /// Whether it is [`Bounds8::EMPTY`].
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.0[0] == f32::INFINITY
    }

    /// What the spare lanes hold has no meaning.
    #[inline(always)]
    pub(crate) fn grow<S: Simd>(&mut self, simd: S, other: &Self) {
        self.0 = simd.store(simd.min(simd.load(&self.0), simd.load(&other.0)));
    }
}

/// A primitive's box, with its ids in the spare lanes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Reference {
    pub(super) bounds: Bounds8,
}

impl Reference {
    #[inline(always)]
    pub(crate) fn new(bounds: &Aabb, geometry_id: u32, primitive_id: u32) -> Self {
        let ([a, b, c], [x, y, z]) = (bounds.lower.to_array(), bounds.upper.to_array());
        let ids = [geometry_id, primitive_id].map(f32::from_bits);
        Self { bounds: Bounds8([a, b, c, ids[0], -x, -y, -z, ids[1]]) }
    }

    #[inline(always)]
    pub(crate) fn bounds(&self) -> &Bounds8 {
        &self.bounds
    }

    /// Its lower and its upper bound.
    #[inline(always)]
    pub(super) fn extent_along(&self, axis: usize) -> (f32, f32) {
        (self.bounds.0[axis & 3], -self.bounds.0[(axis & 3) + 4])
    }

    #[inline(always)]
    pub(crate) fn geometry_id(&self) -> u32 {
        self.bounds.0[3].to_bits()
    }

    #[inline(always)]
    pub(crate) fn primitive_id(&self) -> u32 {
        self.bounds.0[7].to_bits()
    }

    /// Leaves the ids.
    pub(super) fn set_bounds(&mut self, bounds: &Bounds8) {
        *self = Self::new(&bounds.to_aabb(), self.geometry_id(), self.primitive_id());
    }

    /// The order in which equal hits win.
    pub(super) fn ids(&self) -> (u32, u32) {
        (self.geometry_id(), self.primitive_id())
    }

    #[inline(always)]
    pub(super) fn primitive<S: PrimitiveSource>(&self, source: &S) -> S::Primitive {
        source.primitive(self.geometry_id(), self.primitive_id())
    }
}

/// The primitives themselves, in the order of their references.
pub(super) fn gather<S: PrimitiveSource>(
    source: &S,
    references: &[Reference],
    context: &BuildContext,
) -> Result<Vec<S::Primitive>, BuildFailure> {
    let mut primitives = context.reserve(references.len())?;
    let primitive = |reference: &Reference| reference.primitive(source);
    if context.is_parallel() {
        primitives.par_extend(references.par_iter().map(primitive));
    } else {
        primitives.extend(references.iter().map(primitive));
    }
    Ok(primitives)
}
