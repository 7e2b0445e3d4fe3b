//! The structures as one type, matched once a call: a new one cannot be forgotten.

use super::brute_force::BruteForce;
use super::bsp_tree::BspTree;
use super::bvh::{BinnedSah, Bvh, Median};
use super::grid::Grid;
use super::kd_tree::KdTree;
use super::octree::Octree;
use super::reference::{PrimitiveSource, Reference, gather};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Primitive, Quality, Structure, WideBvh};
use crate::geometry::Aabb;

pub(crate) enum AnyAccel<T: Primitive> {
    BruteForce(BruteForce<T>),
    Grid(Grid<T>),
    Octree(Octree<T>),
    KdTree(KdTree<T>),
    BspTree(BspTree<T>),
    Bvh(Bvh<T>),
    WideBvh(WideBvh<T::Leaves>),
    CompactWideBvh(WideBvh<T::CompactLeaves>),
}

impl<T: Primitive> AnyAccel<T> {
    pub(crate) fn shape(&self) -> Shape {
        match self {
            Self::BruteForce(brute_force) => brute_force.shape(),
            Self::Grid(grid) => grid.shape(),
            Self::Octree(octree) => octree.shape(),
            Self::KdTree(tree) => tree.shape(),
            Self::BspTree(tree) => tree.shape(),
            Self::Bvh(bvh) => bvh.shape(),
            Self::WideBvh(bvh) => bvh.shape(),
            Self::CompactWideBvh(bvh) => bvh.shape(),
        }
    }
}

impl<T: Primitive> AnyAccel<T> {
    /// Each primitive's ids, with a number by which [`AnyAccel::at_place`] finds it. What a hierarchy cut may come more than
    /// once.
    pub(super) fn for_each_place(&self, mut visit: impl FnMut(u32, (u32, u32))) {
        match self.stored() {
            Stored::List(primitives) => {
                for (place, primitive) in (0..).zip(primitives) {
                    visit(place, primitive.ids());
                }
            }
            Stored::Leaves(bvh) => bvh.for_each_place(visit),
            Stored::CompactLeaves(bvh) => bvh.for_each_place(visit),
        }
    }

    pub(super) fn at_place(&self, place: u32, ids: (u32, u32)) -> Option<T> {
        match self.stored() {
            Stored::List(primitives) => primitives.get(place as usize).copied(),
            Stored::Leaves(bvh) => bvh.at_place(place, ids),
            Stored::CompactLeaves(bvh) => bvh.at_place(place, ids),
        }
    }

    fn stored(&self) -> Stored<'_, T> {
        match self {
            Self::BruteForce(brute_force) => Stored::List(brute_force.primitives()),
            Self::Grid(grid) => Stored::List(grid.primitives()),
            Self::Octree(octree) => Stored::List(octree.primitives()),
            Self::KdTree(tree) => Stored::List(tree.primitives()),
            Self::BspTree(tree) => Stored::List(tree.primitives()),
            Self::Bvh(bvh) => Stored::List(&bvh.primitives),
            Self::WideBvh(bvh) => Stored::Leaves(bvh),
            Self::CompactWideBvh(bvh) => Stored::CompactLeaves(bvh),
        }
    }
}

/// Where a structure has its primitives.
enum Stored<'a, T: Primitive> {
    List(&'a [T]),
    Leaves(&'a WideBvh<T::Leaves>),
    CompactLeaves(&'a WideBvh<T::CompactLeaves>),
}

/// What `Auto` stands for. On random triangles the binary BVH takes 1.51, 1.28 and 1.12 times as long as brute force at 8, 16
/// and 24 triangles; where they overlap less it catches up earlier.
pub(crate) fn choose(asked: Structure, primitive_count: usize) -> Structure {
    const MOST_FOR_BRUTE_FORCE: usize = 16;
    match asked {
        _ if primitive_count == 0 => Structure::BruteForce,
        Structure::Auto if primitive_count <= MOST_FOR_BRUTE_FORCE => Structure::BruteForce,
        Structure::Auto => Structure::WideBvh,
        other => other,
    }
}

/// What is to be built.
#[derive(Clone, Copy)]
pub(crate) struct Plan {
    /// What [`choose`] made of a choice.
    pub(crate) structure: Structure,
    pub(crate) quality: Quality,
    /// Only the wide BVH can be.
    pub(crate) is_compact: bool,
    /// 0: what suits the quality.
    pub(crate) grid_cells_per_triangle: f32,
}

/// Builds what is planned.
pub(crate) fn build<S: PrimitiveSource>(
    plan: Plan,
    references: Vec<Reference>,
    bounds: Aabb,
    source: &S,
    context: &BuildContext,
) -> Result<AnyAccel<S::Primitive>, BuildFailure> {
    let Plan { structure, quality, is_compact, grid_cells_per_triangle } = plan;
    match (structure, quality) {
        (Structure::BruteForce, _) => {
            let primitives = gather(source, &references, context)?;
            context.release(references);
            BruteForce::build(primitives, context).map(AnyAccel::BruteForce)
        }
        (Structure::Grid, _) => {
            Grid::build(references, bounds, grid_cells_per_triangle, quality, source, context).map(AnyAccel::Grid)
        }
        (Structure::Octree, _) => Octree::build(references, bounds, quality, source, context).map(AnyAccel::Octree),
        (Structure::KdTree, _) => KdTree::build(references, bounds, quality, source, context).map(AnyAccel::KdTree),
        (Structure::BspTree, _) => BspTree::build(references, bounds, quality, source, context).map(AnyAccel::BspTree),
        (Structure::Bvh, Quality::Low) => Bvh::build(references, bounds, &Median, source, context).map(AnyAccel::Bvh),
        (Structure::Bvh, Quality::Medium) => {
            let rule = &BinnedSah::FOR_SCALAR_LEAVES;
            Bvh::build(references, bounds, rule, source, context).map(AnyAccel::Bvh)
        }
        (Structure::Bvh, Quality::High) => Bvh::build_high(references, bounds, source, context).map(AnyAccel::Bvh),
        (Structure::WideBvh, _) if is_compact => {
            WideBvh::build(references, bounds, quality, source, context).map(AnyAccel::CompactWideBvh)
        }
        (Structure::WideBvh, _) => WideBvh::build(references, bounds, quality, source, context).map(AnyAccel::WideBvh),
        _ => unreachable!("{structure:?} of quality {quality:?} is refused before anything is built"),
    }
}
