//! The structures as one type, matched once a call: a new one cannot be forgotten.

use super::brute_force::BruteForce;
use super::bvh::{BinnedSah, Bvh, Median};
use super::reference::{Reference, TriangleSource, gather};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Compact, Quality, Structure, WideBvh};
use crate::geometry::{Aabb, Triangle};

pub(crate) enum AnyAccel {
    BruteForce(BruteForce<Triangle>),
    Bvh(Bvh<Triangle>),
    WideBvh(WideBvh),
    CompactWideBvh(WideBvh<Compact>),
}

impl AnyAccel {
    pub(crate) fn shape(&self) -> Shape {
        match self {
            Self::BruteForce(brute_force) => brute_force.shape(),
            Self::Bvh(bvh) => bvh.shape(),
            Self::WideBvh(bvh) => bvh.shape(),
            Self::CompactWideBvh(bvh) => bvh.shape(),
        }
    }
}

/// What `Auto` stands for. On random triangles the binary BVH takes 1.51, 1.28 and 1.12 times as long as brute force at 8, 16
/// and 24 triangles; where they overlap less it catches up earlier.
pub(crate) fn choose(asked: Structure, triangle_count: usize) -> Structure {
    const MOST_FOR_BRUTE_FORCE: usize = 16;
    match asked {
        _ if triangle_count == 0 => Structure::BruteForce,
        Structure::Auto if triangle_count <= MOST_FOR_BRUTE_FORCE => Structure::BruteForce,
        Structure::Auto => Structure::WideBvh,
        other => other,
    }
}

/// What the choice names that has no builder yet.
pub(crate) fn unsupported(structure: Structure) -> Option<&'static str> {
    match structure {
        Structure::Auto | Structure::BruteForce | Structure::Bvh | Structure::WideBvh => None,
        Structure::Grid => Some("GNOMON_STRUCTURE_GRID, the uniform grid,"),
        Structure::Octree => Some("GNOMON_STRUCTURE_OCTREE, the octree,"),
        Structure::KdTree => Some("GNOMON_STRUCTURE_KD_TREE, the kd-tree,"),
        Structure::BspTree => Some("GNOMON_STRUCTURE_BSP_TREE, the BSP tree,"),
    }
}

/// Builds what [`choose`] made of a choice that is not [`unsupported`]. Only the wide BVH can be compact.
pub(crate) fn build(
    structure: Structure,
    quality: Quality,
    is_compact: bool,
    references: Vec<Reference>,
    bounds: Aabb,
    source: &impl TriangleSource,
    context: &BuildContext,
) -> Result<AnyAccel, BuildFailure> {
    match (structure, quality) {
        (Structure::BruteForce, _) => {
            let primitives = gather(source, &references, context)?;
            context.release(references);
            BruteForce::build(primitives, context).map(AnyAccel::BruteForce)
        }
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
