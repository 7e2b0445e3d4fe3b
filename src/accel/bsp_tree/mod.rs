//! BSP tree: planes of thirteen fixed directions and of the triangles themselves.
//!
//! Shines where walls and edges run across the axes; the tree holds cells that follow them. Fails, as the kd-tree does,
//! where triangles cross: each is cut by the planes of others.
//!
//! Sources: Kammaje and Mora 2007, "A study of restricted BSP trees for ray tracing", for the fixed directions; Ize,
//! Wald, Parker 2008, "Ray tracing with the BSP tree", for the rest.

mod cell;
mod directions;
mod split;
mod traverse;

use self::cell::Cell;
use self::directions::height_of;
use self::split::Candidates;
use super::space_tree::{Divide, Side, SpaceTree, Split};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Part, Primitive, PrimitiveSource, Quality, Reference};
use crate::geometry::Aabb;
use crate::math::UNIT_ROUNDOFF;

pub(crate) struct BspTree<T> {
    tree: SpaceTree<T>,
    tolerance: f64,
}

/// How far along each axis a primitive may reach over a plane without being taken to both sides, in the scene's size:
/// so that what lies in a slanted plane, which no coordinates can express, is not cut by it. It is added to the band of
/// a walk; and it is far more than the roundings of 64 cuts in `f64`, at most `2^-46` of the largest coordinate.
const TOLERANCE: f64 = 8.0 * UNIT_ROUNDOFF as f64;

impl<T: Primitive> BspTree<T> {
    /// At least one reference; `bounds` contains them all.
    pub(crate) fn build(
        references: Vec<Reference>,
        bounds: Aabb,
        quality: Quality,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let size = bounds.upper.as_dvec3() - bounds.lower.as_dvec3();
        let tolerance = TOLERANCE * size.max_element();
        let planes = AnyPlanes { source, tolerance, has_own_planes: quality != Quality::Low };
        let mut pieces = context.reserve(references.len())?;
        let piece = |(): &mut (), at: u32| {
            let reference = &references[at as usize];
            let number = source.starts()[reference.geometry_id() as usize] + reference.primitive_id();
            Piece { part: reference.primitive(source).whole(), number }
        };
        context.collect_with(&mut pieces, references.len() as u32, |_| (), piece);
        context.release(references);
        let tree = SpaceTree::build(&planes, Cell::of(&bounds), pieces, bounds, source, context)?;
        #[cfg(any(test, debug_assertions))]
        tree.validate(2.0 * tolerance, |node| directions::plane_of(node, &tree.planes))
            .expect("a builder keeps the tree's invariants");
        Ok(Self { tree, tolerance })
    }

    /// Each once.
    pub(super) fn primitives(&self) -> &[T] {
        &self.tree.primitives
    }

    pub(crate) fn shape(&self) -> Shape {
        self.tree.shape()
    }
}

/// A primitive's part in a cell.
#[derive(Clone, Copy)]
struct Piece<P> {
    part: P,
    number: u32,
}

struct AnyPlanes<'a, S> {
    source: &'a S,
    tolerance: f64,
    /// Whether the planes of primitives are candidates.
    has_own_planes: bool,
}

type PartOf<S> = <<S as PrimitiveSource>::Primitive as Primitive>::Part;

impl<S: PrimitiveSource> Divide for AnyPlanes<'_, S> {
    type Cell = Cell;
    type Piece = Piece<PartOf<S>>;
    type Scratch = Candidates;

    const PRIMITIVE_COST: f64 = split::PRIMITIVE_COST;
    const MOST_COPIES: usize = 8;

    fn number(&self, piece: &Self::Piece) -> u32 {
        piece.number
    }

    fn half_area(&self, cell: &Cell) -> f64 {
        cell.half_area()
    }

    fn choose(&self, cell: &Cell, pieces: &[Self::Piece], _level: usize, scratch: &mut Candidates) -> Option<Split> {
        split::choose(self, cell, pieces, scratch)
    }

    fn divide(&self, cell: &Cell, split: &Split) -> [Cell; 2] {
        let (normal, distance) = directions::normal_and_distance(split);
        cell.divide(normal, distance)
    }

    #[inline(always)]
    fn side(&self, piece: &Self::Piece, split: &Split) -> Side {
        let tolerance = self.tolerance * directions::length_of(split);
        let (least, greatest) = piece.part.extent(height_of(split));
        match (least < -tolerance, greatest > tolerance) {
            (true, true) => Side::Both,
            (true, false) => Side::Below,
            (false, true) => Side::Above,
            (false, false) => match split {
                Split::Fixed { is_planar_below: false, .. } => Side::Above,
                _ => Side::Below,
            },
        }
    }

    fn cut(&self, piece: &Self::Piece, split: &Split, _cells: &[Cell; 2]) -> [Self::Piece; 2] {
        let height = height_of(split);
        // Both are there: the piece reaches over the plane on both sides.
        let below = piece.part.below(height).unwrap_or(piece.part);
        let above = piece.part.below(|point| -height(point)).unwrap_or(piece.part);
        [below, above].map(|part| Piece { part, ..*piece })
    }
}
