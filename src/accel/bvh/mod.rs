//! Binary bounding volume hierarchy: a box in every node, two children or a run of primitives below it.
//!
//! Shines on everything that is unevenly spread; each triangle is stored once, unless quality HIGH finds that parts of it
//! are better apart. Fails where boxes overlap much: many triangles in one place, and below HIGH long diagonal ones.

pub(super) mod build;
mod chopped_bins;
mod clip;
pub(super) mod node;
mod pack;
pub(super) mod reinsert;
mod split_median;
mod split_morton;
mod split_sah;
pub(super) mod split_spatial;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;

pub(crate) use split_median::Median;
pub(crate) use split_morton::Morton;
pub(crate) use split_sah::BinnedSah;

use build::{BinaryTree, SplitRule};
use node::{Node, NodePair};

use super::reference::{PrimitiveSource, Reference};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Primitive};
use crate::geometry::Aabb;

pub(crate) struct Bvh<T> {
    pub(super) bounds: Aabb,
    pub(super) root: Node,
    /// A node's children come after it.
    pub(super) pairs: Vec<NodePair>,
    /// In the order of the leaves.
    pub(super) primitives: Vec<T>,
    depth: u32,
    sah_cost: f64,
}

impl<T: Primitive> Bvh<T> {
    /// At least one reference; `bounds` contains them all.
    pub(crate) fn build<R: SplitRule>(
        mut references: Vec<Reference>,
        bounds: Aabb,
        rule: &R,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let count = references.len();
        context.expect(2 * count);
        let tree = build::build(&mut references, count, rule, source, context)?;
        let bvh = Self::finish(tree, bounds, source, context)?;
        context.release(references);
        context.advance(count)?;
        Ok(bvh)
    }

    /// As [`Bvh::build`], of quality HIGH.
    pub(crate) fn build_high(
        mut references: Vec<Reference>,
        bounds: Aabb,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let count = references.len();
        let (mut divided, mut reordered) = (Vec::new(), Vec::new());
        let rule = BinnedSah::FOR_SCALAR_LEAVES;
        let most = u32::MAX as usize;
        let tree = split_spatial::build(&mut references, &mut divided, rule, most, source, context)?;
        let tree = reinsert::reinsert(tree, &mut reordered, context)?;
        context.expect(count);
        let bvh = Self::finish(tree, bounds, source, context)?;
        context.release(references);
        context.release(divided);
        context.release(reordered);
        context.advance(count)?;
        Ok(bvh)
    }

    fn finish(
        tree: BinaryTree,
        bounds: Aabb,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let bvh = pack::pack(tree, bounds, source, context)?;
        #[cfg(any(test, debug_assertions))]
        bvh.validate().expect("a builder keeps the tree's invariants");
        Ok(bvh)
    }

    pub(crate) fn shape(&self) -> Shape {
        let leaf_count = self.pairs.len() + 1;
        Shape {
            reference_count: self.primitives.len(),
            node_count: self.pairs.len() + leaf_count,
            leaf_count,
            depth: self.depth,
            node_bytes: size_of_val(self.pairs.as_slice()),
            leaf_bytes: size_of_val(self.primitives.as_slice()),
            sah_cost: self.sah_cost,
        }
    }
}
