//! Splits of space beside those of the references: a triangle that the plane cuts goes to both sides, each with the box of
//! its part.
//!
//! Source: Stich, Friedrich, Dietrich 2009, "Spatial splits in bounding volume hierarchies".

use super::build::{self, BinaryTree, Division, Split, SplitRule};
use super::chopped_bins::{ChoppedBins, CuttingPlane, Fill, Slabs};
use super::clip::halves;
use super::split_sah::{Area, BinnedSah, Bins, ObjectSplit};
use crate::accel::reference::{Bounds8, PrimitiveSource, Reference};
use crate::accel::{BuildContext, BuildFailure, Primitive};
use crate::simd::{Scalar, Simd};

/// For so many references there may be one more: what nodes and leaves need grows as much.
const REFERENCES_PER_REPEAT: usize = 4;
/// What the children of a split of references must share, of the scene's area and of the node's, for space to be tried.
/// With 1e-3 of the scene's, trees cost 0 to 3 % less, and take a tenth longer and up to 10 % more references; 1e-5, as in
/// the paper, makes them no better than that.
const LEAST_SHARE_OF_SCENE: f64 = 1e-2;
const LEAST_SHARE_OF_NODE: f64 = 0.1;
/// What the leaves must cost, at most, of those of the tree without, which reinsertion does not change: they tell what the
/// finished tree costs. Where large triangles lie among small ones they grow, up to half as much again, however much the
/// nodes shrink.
const MOST_LEAF_COST: f64 = 0.97;

/// Larger scenes are tried in part first.
const LEAST_FOR_SAMPLE: usize = 4 * SAMPLE;
const SAMPLE: usize = 1 << 14;
/// As [`MOST_LEAF_COST`] for the part. Measured: 0.60 to 0.98 where cutting pays for the whole, 0.9995 and above where not.
const MOST_SAMPLE_COST: f64 = 0.99;

/// The tree of the references; or, where that is better, one of more references, which `divided` has then. They are no
/// more than `most_references`.
pub(in crate::accel) fn build<'r, T: PrimitiveSource>(
    references: &'r mut [Reference],
    divided: &'r mut Vec<Reference>,
    rule: BinnedSah,
    most_references: usize,
    source: &T,
    context: &BuildContext,
) -> Result<BinaryTree<'r>, BuildFailure> {
    let count = references.len();
    if !T::Primitive::IS_TRIANGLE {
        return build::build(references, count, &rule, source, context);
    }
    if count > LEAST_FOR_SAMPLE && !pays_for_sample(references, &rule, source, context)? {
        return build::build(references, count, &rule, source, context);
    }
    let room = (count / REFERENCES_PER_REPEAT).min(most_references - count);
    context.expect(2 * count);
    *divided = context.filled(count + room, references[0])?;
    divided[..count].copy_from_slice(references);
    let ordinary = build::build(references, count, &rule, source, context)?;
    let least_overlap = LEAST_SHARE_OF_SCENE * ordinary.top[0].half_area();
    let spatial_rule = SpatialSah { rule: &rule, source, least_overlap };
    let spatial = build::build(divided, count, &spatial_rule, source, context)?;
    let is_better = leaf_cost(&spatial, &rule) <= MOST_LEAF_COST * leaf_cost(&ordinary, &rule);
    let (better, other) = if is_better { (spatial, ordinary) } else { (ordinary, spatial) };
    for subtree in other.subtrees {
        context.release(subtree.nodes);
    }
    Ok(better)
}

/// Whether it would be better for a part of the references, evenly spread in their order, which costs little to find out. What
/// large triangles spoil among small ones shows in the part; small ones that overlap everywhere, of which cutting makes
/// nothing better, do so less.
fn pays_for_sample<T: PrimitiveSource>(
    references: &[Reference],
    rule: &BinnedSah,
    source: &T,
    context: &BuildContext,
) -> Result<bool, BuildFailure> {
    let mut ordinary = context.reserve(SAMPLE)?;
    ordinary.extend((0..SAMPLE).map(|at| references[(at * references.len()) / SAMPLE]));
    let mut divided = context.filled_here(SAMPLE + SAMPLE / REFERENCES_PER_REPEAT, ordinary[0])?;
    divided[..SAMPLE].copy_from_slice(&ordinary);
    context.expect(2 * SAMPLE);
    let ordinary_tree = build::build(&mut ordinary, SAMPLE, rule, source, context)?;
    let least_overlap = LEAST_SHARE_OF_SCENE * ordinary_tree.top[0].half_area();
    let spatial_tree =
        build::build(&mut divided, SAMPLE, &SpatialSah { rule, source, least_overlap }, source, context)?;
    let is_better = leaf_cost(&spatial_tree, rule) <= MOST_SAMPLE_COST * leaf_cost(&ordinary_tree, rule);
    for subtree in ordinary_tree.subtrees.into_iter().chain(spatial_tree.subtrees) {
        context.release(subtree.nodes);
    }
    context.release(ordinary);
    context.release(divided);
    Ok(is_better)
}

/// Of all leaves; in the order of the tree, so that threads make no difference.
fn leaf_cost(tree: &BinaryTree, rule: &BinnedSah) -> f64 {
    let nodes = tree.subtrees.iter().flat_map(|subtree| &subtree.nodes);
    nodes.filter(|node| node.is_leaf()).map(|leaf| rule.cost_of_leaf(leaf)).sum()
}

struct SpatialSah<'a, T> {
    rule: &'a BinnedSah,
    source: &'a T,
    /// The area that children must share for space to be tried.
    least_overlap: f64,
}

/// In a subtree space is tried until this many more attempts have failed than [`ATTEMPTS_PER_CUT`] for each cut.
const PATIENCE: i32 = 16;
const ATTEMPTS_PER_CUT: i32 = 4;

struct Scratch {
    bins: Bins,
    chopped: ChoppedBins,
    /// How many more attempts may fail.
    patience: i32,
}

impl Default for Scratch {
    fn default() -> Self {
        Self { bins: Bins::default(), chopped: ChoppedBins::default(), patience: PATIENCE }
    }
}

impl<T: PrimitiveSource> SplitRule for SpatialSah<'_, T> {
    type Scratch = Scratch;

    fn most_in_leaf(&self) -> usize {
        self.rule.most_in_leaf()
    }

    #[inline(always)]
    fn split<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        bounds: &Bounds8,
        scratch: &mut Scratch,
    ) -> Option<Split> {
        self.rule.split(simd, references, bounds, &mut scratch.bins)
    }

    fn split_together(&self, references: &mut [Reference], bounds: &Bounds8, context: &BuildContext) -> Option<Split> {
        self.rule.split_together(references, bounds, context)
    }

    #[inline(always)]
    fn divide<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        count: usize,
        bounds: &Bounds8,
        scratch: &mut Scratch,
    ) -> Option<Division> {
        let object = self.rule.find(simd, &references[..count], bounds, &mut scratch.bins)?;
        if scratch.patience > 0 && references.len() > count && self.may_pay(&object, bounds) {
            scratch.patience -= 1;
            let slabs = Slabs::new(bounds, count);
            scratch.chopped.fill(simd, &references[..count], &slabs, self.source);
            if let Some(plane) = self.cheaper_plane(simd, &scratch.chopped, &slabs, &object, bounds)
                && let Some(division) = self.cut(simd, references, count, plane, &Area::within(bounds))
            {
                scratch.patience += ATTEMPTS_PER_CUT;
                return Some(division);
            }
        }
        Some(object.make(&mut references[..count]).share_out(references, count))
    }

    fn divide_together(
        &self,
        references: &mut [Reference],
        count: usize,
        bounds: &Bounds8,
        context: &BuildContext,
    ) -> Option<Division> {
        let object = self.rule.find_together(&references[..count], bounds, context)?;
        if references.len() > count && self.may_pay(&object, bounds) {
            let slabs = Slabs::new(bounds, count);
            let fill =
                |chunk: &[Reference]| context.vectorize(Fill { references: chunk, slabs: &slabs, source: self.source });
            let chopped = context.reduce_chunks(&references[..count], fill, ChoppedBins::merge)?;
            if let Some(plane) = self.cheaper_plane(Scalar, &chopped, &slabs, &object, bounds)
                && let Some(division) = self.cut(Scalar, references, count, plane, &Area::within(bounds))
            {
                return Some(division);
            }
        }
        Some(object.make_together(&mut references[..count], context).share_out(references, count))
    }
}

impl<T: PrimitiveSource> SpatialSah<'_, T> {
    #[inline(always)]
    fn may_pay(&self, object: &ObjectSplit, bounds: &Bounds8) -> bool {
        let [left, right] = &object.bounds;
        let overlap = half_area(&left.intersection(Scalar, right));
        // False where areas are beyond f32.
        overlap > self.least_overlap && overlap > LEAST_SHARE_OF_NODE * half_area(bounds)
    }

    #[inline(always)]
    fn cheaper_plane<S: Simd>(
        &self,
        simd: S,
        chopped: &ChoppedBins,
        slabs: &Slabs,
        object: &ObjectSplit,
        bounds: &Bounds8,
    ) -> Option<CuttingPlane> {
        let plane = chopped.cheapest_plane(simd, slabs, &Area::within(bounds))?;
        (plane.cost < object.cost()).then_some(plane)
    }

    /// `None`, and nothing done, where there is too little room, or a side would be without a triangle of its own.
    #[inline(always)]
    fn cut<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        count: usize,
        plane: CuttingPlane,
        area: &Area,
    ) -> Option<Division> {
        let (axis, position) = (plane.axis, plane.position);
        let side_of = |reference: &Reference| {
            let [lower, negated_upper] = [reference.bounds().0[axis], reference.bounds().0[axis + 4]];
            (-negated_upper <= position, lower >= position)
        };
        let (mut left_count, mut right_count) = (0, 0);
        for reference in &references[..count] {
            let (is_left, is_right) = side_of(reference);
            left_count += usize::from(is_left);
            right_count += usize::from(is_right & !is_left);
        }
        let cut_count = count - left_count - right_count;
        if left_count == 0 || right_count == 0 || cut_count > references.len() - count {
            return None;
        }
        // Those on the left, those that are cut, those on the right.
        let (mut left, mut next, mut right) = (0, 0, count);
        while next < right {
            let (is_left, is_right) = side_of(&references[next]);
            if is_left {
                references.swap(next, left);
                left += 1;
                next += 1;
            } else if is_right {
                right -= 1;
                references.swap(next, right);
            } else {
                next += 1;
            }
        }
        let mut sides = Sides { bounds: plane.bounds, counts: plane.counts.map(|count| count as f32) };
        let mut end = count;
        while left < right {
            let reference = references[left];
            let triangle = reference.primitive(self.source).as_triangle().expect("nothing else is cut");
            let parts = halves(&triangle, reference.bounds(), axis, position);
            match sides.add(simd, reference.bounds(), &parts, area) {
                Part::Left => left += 1,
                Part::Right => {
                    right -= 1;
                    references.swap(left, right);
                }
                Part::Both => {
                    references[end] = reference;
                    references[end].set_bounds(&parts[1]);
                    references[left].set_bounds(&parts[0]);
                    left += 1;
                    end += 1;
                }
            }
        }
        Some(Split::at(simd, left, &references[..end]).share_out(references, end))
    }
}

/// Where a triangle goes that a plane cuts.
enum Part {
    Left,
    Right,
    Both,
}

/// What lies on either side: at first as if all triangles that the plane cuts went to both.
struct Sides {
    bounds: [Bounds8; 2],
    counts: [f32; 2],
}

impl Sides {
    /// The cheapest place for a triangle with this box and these parts (section 3.3 of the paper: reference unsplitting).
    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, whole: &Bounds8, [left, right]: &[Bounds8; 2], area: &Area) -> Part {
        let [left_bounds, right_bounds] = &mut self.bounds;
        let [left_count, right_count] = &mut self.counts;
        let with = |bounds: &Bounds8, added: &Bounds8| area.of(&bounds.union(simd, added));
        let both = with(left_bounds, left) * *left_count + with(right_bounds, right) * *right_count;
        let all_left = with(left_bounds, whole) * *left_count + area.of(right_bounds) * (*right_count - 1.0);
        let all_right = area.of(left_bounds) * (*left_count - 1.0) + with(right_bounds, whole) * *right_count;
        // A part is empty where the box reaches beyond the plane and the triangle does not.
        let (is_in_left, is_in_right) = (!left.is_empty(), !right.is_empty());
        if !is_in_right || (is_in_left && all_left <= all_right && all_left <= both) {
            left_bounds.grow(simd, whole);
            *right_count -= 1.0;
            Part::Left
        } else if !is_in_left || all_right <= both {
            right_bounds.grow(simd, whole);
            *left_count -= 1.0;
            Part::Right
        } else {
            left_bounds.grow(simd, left);
            right_bounds.grow(simd, right);
            Part::Both
        }
    }
}

/// Half the surface; 0 of an empty box.
fn half_area(bounds: &Bounds8) -> f64 {
    let size = bounds.size().truncate().as_dvec3();
    if size.min_element() < 0.0 { 0.0 } else { size.x * size.y + size.y * size.z + size.z * size.x }
}
