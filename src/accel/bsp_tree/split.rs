//! The surface area heuristic over planes of all fixed directions and of some of the primitives.

use super::cell::Cell;
use super::directions::{DIRECTION_COUNT, DIRECTIONS};
use super::{AnyPlanes, PartOf, Piece};
use crate::accel::space_tree::{Divide, Plane, Side, Split, numbered, split_cost};
use crate::accel::{Part, Primitive, PrimitiveSource};

pub(super) const PRIMITIVE_COST: f64 = 1.0;

/// Smaller cells are not split.
const LEAST_SPLIT: usize = 4;

/// In larger cells the planes between bins are candidates, in others those at both ends of each piece.
const MOST_EXACT: usize = 12;
const BIN_COUNT: usize = 16;

/// For so many directions, the best ones by an estimate, the surface of both parts is computed.
const MOST_MEASURED: usize = 4;

/// So many primitives offer their planes, in cells of no more than [`MOST_OFFERING`], where it is soon known what a
/// plane cuts.
const OFFERED: usize = 3;
const MOST_OFFERING: usize = 256;

/// Room for what is known along one direction.
#[derive(Default)]
pub(super) struct Candidates {
    extents: Vec<(f64, f64)>,
}

/// A plane across one of the fixed directions.
#[derive(Clone, Copy)]
struct Candidate {
    direction: usize,
    position: f32,
    counts: [usize; 2],
    is_planar_below: bool,
    /// From an estimate of the surfaces.
    cost: f64,
}

pub(super) fn choose<S: PrimitiveSource>(
    planes: &AnyPlanes<S>,
    cell: &Cell,
    pieces: &[Piece<PartOf<S>>],
    scratch: &mut Candidates,
) -> Option<Split> {
    if pieces.len() < LEAST_SPLIT {
        return None;
    }
    let mut best = PRIMITIVE_COST * pieces.len() as f64;
    let mut split = None;
    let mut candidates: [Option<Candidate>; DIRECTION_COUNT] =
        std::array::from_fn(|direction| scratch.best_across(direction, planes.tolerance, cell, pieces));
    candidates.sort_by(|a, b| {
        let cost = |candidate: &Option<Candidate>| candidate.map_or(f64::INFINITY, |candidate| candidate.cost);
        cost(a).total_cmp(&cost(b))
    });
    for candidate in candidates.into_iter().flatten().take(MOST_MEASURED) {
        let Candidate { direction, position, counts, is_planar_below, .. } = candidate;
        let [below, above, _] = cell.shares(DIRECTIONS[direction], f64::from(position));
        let cost = split_cost([below, above], counts, PRIMITIVE_COST);
        if cost < best {
            best = cost;
            split = Some(Split::Fixed { direction: direction as u32, position, is_planar_below });
        }
    }
    if planes.has_own_planes && pieces.len() <= MOST_OFFERING {
        for offer in 0..OFFERED.min(pieces.len()) {
            let number = pieces[offer * pieces.len() / OFFERED].number;
            let Some(plane) = own_plane(&numbered(planes.source, number)) else { continue };
            let own = Split::Any(plane);
            let mut counts = [0; 2];
            for piece in pieces {
                let side = planes.side(piece, &own);
                counts[0] += usize::from(side != Side::Above);
                counts[1] += usize::from(side != Side::Below);
            }
            if counts == [pieces.len(); 2] {
                continue;
            }
            let (normal, distance) = plane.normal_and_distance();
            let (least, greatest) = cell.extent(normal);
            if !(least < distance && distance < greatest) {
                continue;
            }
            let [below, above, _] = cell.shares(normal, distance);
            let cost = split_cost([below, above], counts, PRIMITIVE_COST);
            if cost < best {
                best = cost;
                split = Some(own);
            }
        }
    }
    split
}

/// The plane that a primitive lies in, as well as `f32` can tell; none across an axis, for those are candidates anyway.
fn own_plane(primitive: &impl Primitive) -> Option<Plane> {
    let normal = primitive.plane_normal()?;
    let normal = (normal / normal.abs().max_element()).as_vec3();
    let is_across_axis = normal.to_array().into_iter().filter(|&component| component != 0.0).count() < 2;
    let (least, greatest) = primitive.whole().extent(|point| normal.as_dvec3().dot(point));
    let distance = (least * 0.5 + greatest * 0.5) as f32;
    (!is_across_axis && normal.is_finite() && distance.is_finite())
        .then_some(Plane { normal: normal.to_array(), distance })
}

impl Candidates {
    fn best_across<P: Part>(
        &mut self,
        direction: usize,
        tolerance: f64,
        cell: &Cell,
        pieces: &[Piece<P>],
    ) -> Option<Candidate> {
        let normal = DIRECTIONS[direction];
        let tolerance = tolerance * normal.abs().element_sum();
        let (lower, upper) = cell.extent(normal);
        let size = upper - lower;
        // Else all of the cell is in one plane.
        if size <= 2.0 * tolerance {
            return None;
        }
        self.extents.clear();
        self.extents.extend(pieces.iter().map(|piece| piece.part.extent(|point| normal.dot(point))));
        // As if the surface beside the cut were the same everywhere.
        let [_, _, cut] = cell.shares(normal, lower + 0.5 * size);
        let mut best: Option<Candidate> = None;
        let mut offer = |position: f32, counts: [usize; 2], is_planar_below: bool| {
            let height = (f64::from(position) - lower) / size;
            if !(0.0 < height && height < 1.0) {
                return;
            }
            let shares = [height, 1.0 - height].map(|height| cut + (1.0 - cut) * height);
            let cost = split_cost(shares, counts, PRIMITIVE_COST);
            if best.is_none_or(|best| cost < best.cost) {
                best = Some(Candidate { direction, position, counts, is_planar_below, cost });
            }
        };
        if pieces.len() <= MOST_EXACT {
            for &(least, greatest) in &self.extents {
                for (position, is_planar_below) in [(least as f32, false), (greatest as f32, true)] {
                    let counts = counts_at(&self.extents, f64::from(position), tolerance, is_planar_below);
                    offer(position, counts, is_planar_below);
                }
            }
        } else {
            bin(&self.extents, &mut offer);
        }
        best
    }
}

/// How many pieces a plane puts on each side.
fn counts_at(extents: &[(f64, f64)], position: f64, tolerance: f64, is_planar_below: bool) -> [usize; 2] {
    let mut counts = [0; 2];
    for &(least, greatest) in extents {
        let (is_below, is_above) = (least < position - tolerance, greatest > position + tolerance);
        let is_planar = !is_below && !is_above;
        counts[0] += usize::from(is_below || (is_planar && is_planar_below));
        counts[1] += usize::from(is_above || (is_planar && !is_planar_below));
    }
    counts
}

/// The candidates are the planes between bins of equal width, and the ends of all pieces.
fn bin(extents: &[(f64, f64)], offer: &mut impl FnMut(f32, [usize; 2], bool)) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (lower, upper) = extents.iter().fold(none, |all, &extent| (all.0.min(extent.0), all.1.max(extent.1)));
    offer(lower as f32, [0, extents.len()], false);
    offer(upper as f32, [extents.len(), 0], true);
    let scale = BIN_COUNT as f64 / (upper - lower);
    if !scale.is_finite() {
        return;
    }
    let (mut begun, mut ended) = ([0; BIN_COUNT], [0; BIN_COUNT]);
    let bin_of = |value: f64| (((value - lower) * scale) as usize).min(BIN_COUNT - 1);
    for &(least, greatest) in extents {
        begun[bin_of(least)] += 1;
        ended[bin_of(greatest)] += 1;
    }
    let (mut below, mut above) = (0, extents.len());
    for at in 1..BIN_COUNT {
        below += begun[at - 1];
        above -= ended[at - 1];
        let position = lower + (upper - lower) * (at as f64 / BIN_COUNT as f64);
        offer(position as f32, [below, above], true);
    }
}
