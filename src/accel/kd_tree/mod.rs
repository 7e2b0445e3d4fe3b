//! kd-tree: planes across the axes, cells that do not overlap.
//!
//! Shines where much of the space is empty and triangles are of like size: a ray's first hit in the order of the cells is
//! the closest. Fails where triangles are long and slanted: each is listed in many cells.

mod split_median;
mod split_sah;
mod traverse;

use glam::DVec3;

use self::split_sah::Sah;
use super::space_tree::{Divide, Side, SpaceTree, Split};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Part, Primitive, PrimitiveSource, Quality, Reference};
use crate::geometry::Aabb;
#[cfg(any(test, debug_assertions))]
use crate::math::UNIT_ROUNDOFF;

pub(crate) struct KdTree<T> {
    tree: SpaceTree<T>,
}

impl<T: Primitive> KdTree<T> {
    /// At least one reference; `bounds` contains them all.
    pub(crate) fn build(
        references: Vec<Reference>,
        bounds: Aabb,
        quality: Quality,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        let rule = if quality == Quality::Low { Rule::Median } else { Rule::Sah };
        let tree = SpaceTree::build(&AxisPlanes { rule, source }, bounds, references, bounds, source, context)?;
        #[cfg(any(test, debug_assertions))]
        {
            // What rounding may leave out: much less than the band, 24 times this at the least.
            let size = (bounds.upper.as_dvec3() - bounds.lower.as_dvec3()).max_element();
            tree.validate(f64::from(UNIT_ROUNDOFF) * size, |node| {
                (DVec3::AXES[node.kind() as usize], f64::from(node.position()))
            })
            .expect("a builder keeps the tree's invariants");
        }
        Ok(Self { tree })
    }

    /// Each once.
    pub(super) fn primitives(&self) -> &[T] {
        &self.tree.primitives
    }

    pub(crate) fn shape(&self) -> Shape {
        self.tree.shape()
    }
}

enum Rule {
    Median,
    Sah,
}

/// A piece is a primitive's box, cut to the cell, that contains what of the primitive is in the cell.
struct AxisPlanes<'a, S> {
    rule: Rule,
    source: &'a S,
}

impl<S: PrimitiveSource> Divide for AxisPlanes<'_, S> {
    type Cell = Aabb;
    type Piece = Reference;
    type Scratch = Sah;

    const PRIMITIVE_COST: f64 = split_sah::PRIMITIVE_COST;
    const MOST_COPIES: usize = 16;

    fn number(&self, piece: &Reference) -> u32 {
        self.source.starts()[piece.geometry_id() as usize] + piece.primitive_id()
    }

    fn half_area(&self, cell: &Aabb) -> f64 {
        half_area(cell.upper.as_dvec3() - cell.lower.as_dvec3())
    }

    fn choose(&self, cell: &Aabb, pieces: &[Reference], level: usize, scratch: &mut Sah) -> Option<Split> {
        match self.rule {
            Rule::Median => split_median::choose(cell, pieces, level),
            Rule::Sah => scratch.choose(cell, pieces),
        }
    }

    fn divide(&self, cell: &Aabb, split: &Split) -> [Aabb; 2] {
        let (axis, position) = plane(split);
        let (mut below, mut above) = (*cell, *cell);
        below.upper[axis] = position;
        above.lower[axis] = position;
        [below, above]
    }

    #[inline(always)]
    fn side(&self, piece: &Reference, split: &Split) -> Side {
        let &Split::Fixed { direction, position, is_planar_below } = split else {
            unreachable!("a plane across an axis")
        };
        let (lower, upper) = piece.extent_along(direction as usize);
        match (lower < position, upper > position) {
            (true, true) => Side::Both,
            (true, false) => Side::Below,
            (false, true) => Side::Above,
            (false, false) if is_planar_below => Side::Below,
            (false, false) => Side::Above,
        }
    }

    fn cut(&self, piece: &Reference, _split: &Split, cells: &[Aabb; 2]) -> [Reference; 2] {
        let bounds = piece.bounds().to_aabb();
        let whole = piece.primitive(self.source).whole();
        cells.each_ref().map(|cell| {
            let bounds = Aabb { lower: bounds.lower.max(cell.lower), upper: bounds.upper.min(cell.upper) };
            let bounds = tight_bounds(&whole, bounds).unwrap_or(bounds);
            Reference::new(&bounds, piece.geometry_id(), piece.primitive_id())
        })
    }
}

/// "Perfect splits" (Wald and Havran 2006, "On building fast kd-trees for ray tracing, and on doing that in O(N log N)"):
/// the box of the part in `bounds`, rounded outward, no larger than `bounds`. `None` where rounding leaves nothing.
fn tight_bounds(whole: &impl Part, bounds: Aabb) -> Option<Aabb> {
    let (mut part, limits) = (*whole, (bounds.lower.as_dvec3(), bounds.upper.as_dvec3()));
    let (lower, upper) = whole.bounds();
    for axis in 0..3 {
        if lower[axis] < limits.0[axis] {
            part = part.below(|point| limits.0[axis] - point[axis])?;
        }
        if upper[axis] > limits.1[axis] {
            part = part.below(|point| point[axis] - limits.1[axis])?;
        }
    }
    let (lower, upper) = part.bounds();
    let (mut tight, nearest) = (bounds, (lower.as_vec3(), upper.as_vec3()));
    for axis in 0..3 {
        let (low, high) = (nearest.0[axis], nearest.1[axis]);
        let low = if f64::from(low) > lower[axis] { low.next_down() } else { low };
        let high = if f64::from(high) < upper[axis] { high.next_up() } else { high };
        tight.lower[axis] = low.clamp(bounds.lower[axis], bounds.upper[axis]);
        tight.upper[axis] = high.clamp(tight.lower[axis], bounds.upper[axis]);
    }
    Some(tight)
}

fn half_area(size: DVec3) -> f64 {
    size.x * size.y + size.y * size.z + size.z * size.x
}

fn plane(split: &Split) -> (usize, f32) {
    match *split {
        Split::Fixed { direction, position, .. } => (direction as usize, position),
        Split::Any(_) => unreachable!("a plane across an axis"),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::geometry::Triangle;

    #[test]
    fn tight_bounds_of_a_triangle_that_has_all_vertices_outside_are_those_of_its_part() {
        let triangle = Triangle::new([[-1.0, 0.25, 0.5], [2.0, 0.25, 0.5], [0.5, 3.0, 0.5]], 0, 0);
        let cell = Aabb { lower: Vec3::ZERO, upper: Vec3::new(1.0, 0.5, 1.0) };
        let tight = tight_bounds(&triangle.whole(), cell);
        let expected = Aabb { lower: Vec3::new(0.0, 0.25, 0.5), upper: Vec3::new(1.0, 0.5, 0.5) };
        assert_eq!(tight, Some(expected));
    }

    #[test]
    fn tight_bounds_are_rounded_outward() {
        let triangle = Triangle::new([[0.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.0, 0.0, 1.0]], 0, 0);
        let cell = Aabb { lower: Vec3::ZERO, upper: Vec3::ONE };
        let tight = tight_bounds(&triangle.whole(), cell).expect("the triangle reaches into the cell");
        assert_eq!((tight.lower, tight.upper.x), (Vec3::ZERO, 1.0));
        assert!(3.0 * f64::from(tight.upper.y) >= 1.0 && 3.0 * f64::from(tight.upper.y.next_down()) < 1.0);
    }
}
