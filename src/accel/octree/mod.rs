//! Octree: a cube cut into eight, and those again where there is much in them; each leaf lists the primitives that overlap
//! it (Glassner 1984, "Space subdivision for fast ray tracing").
//!
//! Shines where much of the space is empty, and on scenes that are clustered, at any size of the clusters. Fails on long
//! thin primitives, which many leaves list.

mod build;
mod cell;
mod node;
mod subtree;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;

use cell::Cube;
use node::Node;

use super::along_curve::gather_along_curve;
use super::reference::{PrimitiveSource, Reference};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Primitive, Quality};
use crate::geometry::Aabb;

/// Where cutting ends.
#[derive(Clone, Copy)]
struct StopRule {
    /// Cells with no more primitives are leaves.
    most_in_leaf: usize,
    /// The cost of a visit to a node with children, in triangle tests: what cutting has to save.
    node_cost: f64,
}

impl StopRule {
    fn of(quality: Quality) -> Self {
        match quality {
            Quality::Low => Self { most_in_leaf: 16, node_cost: 4.0 },
            Quality::Medium => Self { most_in_leaf: 8, node_cost: 2.0 },
            Quality::High => Self { most_in_leaf: 6, node_cost: 1.0 },
        }
    }
}

pub(crate) struct Octree<T> {
    bounds: Aabb,
    cube: Cube,
    /// The root first; siblings side by side, after their parent.
    nodes: Vec<Node>,
    /// Numbers of primitives, leaf by leaf.
    listed: Vec<u32>,
    primitives: Vec<T>,
    leaf_count: usize,
    depth: u32,
    sah_cost: f64,
}

impl<T: Primitive> Octree<T> {
    /// At least one reference; `bounds` contains them all.
    pub(crate) fn build(
        references: Vec<Reference>,
        bounds: Aabb,
        quality: Quality,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        context.expect(2 * references.len());
        let primitives = gather_along_curve(references, &bounds, source, context)?;
        let octree = build::build(primitives, bounds, StopRule::of(quality), context)?;
        #[cfg(any(test, debug_assertions))]
        octree.validate().expect("a builder keeps the tree's invariants");
        Ok(octree)
    }

    /// Each once.
    pub(super) fn primitives(&self) -> &[T] {
        &self.primitives
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape {
            reference_count: self.listed.len(),
            node_count: self.nodes.len(),
            leaf_count: self.leaf_count,
            depth: self.depth,
            node_bytes: size_of_val(self.nodes.as_slice()),
            leaf_bytes: size_of_val(self.listed.as_slice()) + size_of_val(self.primitives.as_slice()),
            sah_cost: self.sah_cost,
        }
    }
}
