//! What trees of planes have in common: kd-tree and BSP tree.
//!
//! Each plane divides its cell, and each leaf lists the primitives that have a part in its cell: every point of a
//! primitive is in a leaf that lists it. A primitive is stored once, in the order of the first leaf that lists it.

mod build;
mod node;
mod pack;
mod sah;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;

pub(super) use build::{Divide, Side, Split};
pub(super) use node::{ANY, Node};
pub(super) use pack::numbered;
pub(super) use sah::split_cost;
pub(super) use traverse::Slope;

use glam::{DVec3, Vec3};
use node::NodePair;

use super::stats::Shape;
use super::{BuildContext, BuildFailure, Primitive, PrimitiveSource};
use crate::geometry::Aabb;

/// Where `normal . p = distance`. 16 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: [f32; 3],
    pub(super) distance: f32,
}

const _: () = assert!(size_of::<Plane>() == 16);

impl Plane {
    #[inline(always)]
    pub(super) fn normal_and_distance(&self) -> (DVec3, f64) {
        (Vec3::from_array(self.normal).as_dvec3(), f64::from(self.distance))
    }
}

pub(super) struct SpaceTree<T> {
    pub(super) bounds: Aabb,
    pub(super) root: Node,
    /// A node's children come after it.
    pub(super) pairs: Vec<NodePair>,
    /// Those that no fixed direction has; none in a kd-tree.
    pub(super) planes: Vec<Plane>,
    /// The leaves' lists, one after the other.
    pub(super) lists: Vec<u32>,
    pub(super) primitives: Vec<T>,
    depth: u32,
    sah_cost: f64,
}

impl<T: Primitive> SpaceTree<T> {
    pub(super) fn shape(&self) -> Shape {
        let leaf_count = self.pairs.len() + 1;
        Shape {
            reference_count: self.lists.len(),
            node_count: self.pairs.len() + leaf_count,
            leaf_count,
            depth: self.depth,
            node_bytes: size_of_val(self.pairs.as_slice()) + size_of_val(self.planes.as_slice()),
            leaf_bytes: size_of_val(self.lists.as_slice()) + size_of_val(self.primitives.as_slice()),
            sah_cost: self.sah_cost,
        }
    }

    /// At least one piece; `bounds` contains them all.
    pub(super) fn build<D: Divide>(
        divide: &D,
        cell: D::Cell,
        pieces: Vec<D::Piece>,
        bounds: Aabb,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        build::build(divide, cell, pieces, bounds, source, context)
    }
}
