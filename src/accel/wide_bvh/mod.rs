//! Bounding volume hierarchy with eight children a node, tested at once; a leaf's triangles are too.
//!
//! Shines on everything that is unevenly spread, in less memory than the binary one. Fails where boxes overlap much.
//! Source: Wald, Benthin, Boulos 2008, "Getting rid of packets: efficient SIMD single-ray traversal using
//! multi-branching BVHs".

mod box_test;
mod collapse;
mod compact_leaves;
mod leaf_test;
mod leaves;
mod node;
mod packet;
#[cfg(test)]
mod tests;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;
mod wavefront;

pub(crate) use compact_leaves::Compact;
use glam::Vec4;
use leaves::{ByAxis, LeafForm, Leaves};
use node::{Child, WideNode};
use wavefront::Wavefront;

use super::bvh::{BinnedSah, Morton, build, reinsert, split_spatial};
use super::reference::{Reference, TriangleSource};
use super::stats::Shape;
use super::{Accel, BuildContext, BuildFailure, ClosestHit, Quality, Query};
use crate::geometry::{Aabb, PrecisionMode, Ray, Triangle};
use crate::simd::{LANES, Simd, prefetch_lines};

/// The form of its leaves makes no difference to what it answers.
pub(crate) struct WideBvh<F = ByAxis> {
    bounds: Aabb,
    /// Of the bounds, as rays want them.
    corners: [Vec4; 2],
    root: Child,
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
        source: &impl TriangleSource,
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
                let (rule, most) = (BinnedSah::FOR_WIDE_LEAVES, F::MOST_TRIANGLES);
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

    pub(crate) fn shape(&self) -> Shape {
        Shape {
            reference_count: self.leaves.triangle_count(),
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
    let limit = F::MOST_TRIANGLES;
    if count > limit { Err(BuildFailure::TooManyTriangles { count, limit }) } else { Ok(()) }
}

/// A hierarchy that instruction sets query.
pub(crate) trait Vectorize {
    type On<'a, S: Simd>: Accel + Sync
    where
        Self: 'a;

    fn on<S: Simd>(&self, simd: S) -> Self::On<'_, S>;
}

/// The hierarchy as an instruction set queries it.
pub(crate) struct Vectorized<'a, S, F = ByAxis> {
    bvh: &'a WideBvh<F>,
    simd: S,
}

impl Vectorize for WideBvh {
    type On<'a, S: Simd> = Vectorized<'a, S>;

    #[inline(always)]
    fn on<S: Simd>(&self, simd: S) -> Vectorized<'_, S> {
        Vectorized { bvh: self, simd }
    }
}

impl Vectorize for WideBvh<Compact> {
    type On<'a, S: Simd> = Vectorized<'a, S, Compact>;

    #[inline(always)]
    fn on<S: Simd>(&self, simd: S) -> Vectorized<'_, S, Compact> {
        Vectorized { bvh: self, simd }
    }
}

/// Batches go ray by ray.
impl<S: Simd> Accel for Vectorized<'_, S, Compact> {
    type Found = Triangle;

    #[inline(always)]
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit>, Q::Tally) -> R,
    ) -> R {
        self.simd.vectorize(traverse::Traversal::<Q, P, _, _, _>::new(self.bvh, ray, then))
    }
}

impl<S: Simd> Accel for Vectorized<'_, S> {
    type Found = Triangle;

    #[inline(always)]
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit>, Q::Tally) -> R,
    ) -> R {
        self.simd.vectorize(traverse::Traversal::<Q, P, _, _, _>::new(self.bvh, ray, then))
    }

    fn query_runs<'r, Q, P, R, T>(
        &self,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Option<ClosestHit>),
    ) where
        Q: Query,
        P: PrecisionMode,
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        self.simd.vectorize_batch(Wavefront::<Q, P, _, _, _, _>::new(self.bvh, next_run, answer));
    }
}
