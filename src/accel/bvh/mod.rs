//! Binary bounding volume hierarchy: a box in every node, two children or a run of primitives below it.
//!
//! Shines on everything that is unevenly spread; each triangle is stored once. Fails where boxes overlap much: long
//! diagonal triangles, many triangles in one place.

pub(super) mod build;
pub(super) mod node;
mod pack;
pub(super) mod reinsert;
mod split_median;
mod split_morton;
mod split_sah;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;

pub(crate) use split_median::Median;
pub(crate) use split_morton::Morton;
pub(crate) use split_sah::BinnedSah;

use build::SplitRule;
use node::{Node, NodePair};

use super::reference::{PrimitiveSource, Reference};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Primitive, Quality};
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
        quality: Quality,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let count = references.len();
        context.expect(2 * count);
        let mut tree = build::build(&mut references, rule, source, context)?;
        let mut reordered = Vec::new();
        if quality == Quality::High {
            tree = reinsert::reinsert(tree, &mut reordered, context)?;
        }
        let bvh = pack::pack(tree, bounds, source, context)?;
        context.release(references);
        context.release(reordered);
        context.advance(count)?;
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
