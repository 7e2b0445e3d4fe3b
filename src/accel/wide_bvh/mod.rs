//! Bounding volume hierarchy with eight children a node, tested at once; a leaf's triangles are too.
//!
//! Shines on everything that is unevenly spread, in less memory than the binary one. Fails where boxes overlap much.
//! Source: Wald, Benthin, Boulos 2008, "Getting rid of packets: efficient SIMD single-ray traversal using
//! multi-branching BVHs".

mod batch;
mod beam;
mod box_test;
mod coherent;
mod collapse;
mod collect;
mod compact_leaves;
mod leaf_test;
mod leaves;
mod node;
mod packet;
mod spans;
mod sphere_leaves;
#[cfg(test)]
mod tests;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;
mod wavefront;

pub(crate) use compact_leaves::Compact;
use glam::Vec4;
use leaves::Leaves;
pub(crate) use leaves::{ByAxis, LeafForm};
use node::{Child, WideNode};
pub(crate) use sphere_leaves::Spheres;

use super::bvh::{BinnedSah, Morton, build, reinsert, split_spatial};
use super::reference::{PrimitiveSource, Reference};
use super::stats::Shape;
use super::{
    Accel, AllHits, Around, BuildContext, BuildFailure, ClosestHit, Copies, OutOfMemory, Primitive, Quality, Query,
    SortedHits,
};
use crate::geometry::{Aabb, PrecisionMode, Ray};
use crate::simd::{LANES, Simd, prefetch_lines};

/// The form of its leaves makes no difference to what it answers.
pub(crate) struct WideBvh<F = ByAxis> {
    bounds: Aabb,
    /// Of the bounds, as rays want them.
    corners: [Vec4; 2],
    /// The first one is the root.
    nodes: Vec<WideNode>,
    leaves: Leaves<F>,
    depth: u32,
    sah_cost: f64,
}

impl<F: LeafForm> WideBvh<F> {
    /// At least one reference; `bounds` contains them all.
    pub(crate) fn build(
        mut references: Vec<Reference>,
        bounds: Aabb,
        quality: Quality,
        source: &impl PrimitiveSource<Primitive = F::Primitive>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let count = references.len();
        check_count::<F>(count)?;
        let (mut divided, mut reordered) = (Vec::new(), Vec::new());
        context.expect(count);
        let tree = match quality {
            Quality::Low => {
                let rule = Morton::new(&bounds, LANES);
                references = rule.sort(references, context)?;
                context.expect(count);
                build::build(&mut references, count, &rule, source, context)?
            }
            Quality::Medium => {
                context.expect(count);
                build::build(&mut references, count, &BinnedSah::FOR_WIDE_LEAVES, source, context)?
            }
            Quality::High => {
                let (rule, most) = (BinnedSah::FOR_WIDE_LEAVES, F::MOST_PRIMITIVES);
                let tree = split_spatial::build(&mut references, &mut divided, rule, most, source, context)?;
                reinsert::reinsert(tree, &mut reordered, context)?
            }
        };
        let wide = collapse::collapse(tree, bounds, source, context)?;
        context.release(references);
        context.release(divided);
        context.release(reordered);
        #[cfg(any(test, debug_assertions))]
        wide.validate().expect("a builder keeps the tree's invariants");
        Ok(wide)
    }

    /// Asks for a child's cache lines ahead of its use: those of a node, and of a leaf of six triangles.
    #[inline(always)]
    fn prefetch(&self, child: Child) {
        let node = self.nodes.as_ptr().wrapping_add(child.node_index()).cast();
        let leaf = self.leaves.address(child.triangles());
        prefetch_lines::<4>(if child.is_leaf() { leaf } else { node });
    }

    fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + self.leaves.bytes()
    }

    /// Each primitive's ids, with a number by which [`WideBvh::at_place`] finds it: that of its leaf.
    pub(super) fn for_each_place(&self, mut visit: impl FnMut(u32, (u32, u32))) {
        for leaf in self.nodes.iter().flat_map(WideNode::children).filter(|child| child.is_leaf()) {
            for primitive in self.primitives(leaf) {
                visit(leaf.bits(), primitive.ids());
            }
        }
    }

    /// The primitive of the leaf that has the ids.
    pub(super) fn at_place(&self, place: u32, ids: (u32, u32)) -> Option<F::Primitive> {
        self.primitives(Child::from_bits(place)).find(|primitive| primitive.ids() == ids)
    }

    /// With their own ids.
    fn primitives(&self, leaf: Child) -> impl Iterator<Item = F::Primitive> {
        let leaf = leaf.triangles();
        (0..leaf.1).map(move |lane| self.leaves.with_own_ids(self.leaves.primitive(leaf, lane)))
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape {
            reference_count: self.leaves.primitive_count(),
            node_count: self.nodes.len() + self.leaves.leaf_count(),
            leaf_count: self.leaves.leaf_count(),
            depth: self.depth,
            node_bytes: size_of_val(self.nodes.as_slice()),
            leaf_bytes: self.leaves.bytes(),
            sah_cost: self.sah_cost,
        }
    }
}

fn check_count<F: LeafForm>(count: usize) -> Result<(), BuildFailure> {
    let limit = F::MOST_PRIMITIVES;
    if count > limit { Err(BuildFailure::TooManyTriangles { count, limit }) } else { Ok(()) }
}

/// The hierarchy as an instruction set queries it.
pub(crate) struct Vectorized<'a, S, F> {
    bvh: &'a WideBvh<F>,
    simd: S,
}

impl<F: LeafForm> WideBvh<F> {
    #[inline(always)]
    pub(crate) fn on<S: Simd>(&self, simd: S) -> Vectorized<'_, S, F> {
        Vectorized { bvh: self, simd }
    }
}

impl<S: Simd, F: LeafForm> Accel for Vectorized<'_, S, F> {
    type Found = <F::Primitive as Primitive>::Surface;

    #[inline(always)]
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit<Self::Found>>, Q::Tally) -> R,
    ) -> R {
        self.simd.vectorize(traverse::Traversal::<Q, P, _, _, _>::new(self.bvh, ray, then))
    }

    fn find<Q: Query, P: PrecisionMode>(&self, ray: Ray) -> (Option<ClosestHit<Self::Found>>, Q::Tally) {
        self.bvh.find::<Q, P, S>(self.simd, ray)
    }

    fn all_hits<P: PrecisionMode>(&self, ray: &Ray, most: usize, copies: &Copies) -> Result<SortedHits, OutOfMemory> {
        AllHits::find::<P>(ray, most, copies, |all| self.bvh.offer_hits::<P, S>(self.simd, ray, all))
    }

    fn look_around(&self, around: &mut Around) {
        self.bvh.look_around(around);
    }

    fn query_runs<'r, Q, P, R, T>(
        &self,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Option<ClosestHit<Self::Found>>),
    ) where
        Q: Query,
        P: PrecisionMode,
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        F::query_runs::<S, Q, P, R, T>(self, next_run, answer);
    }
}
