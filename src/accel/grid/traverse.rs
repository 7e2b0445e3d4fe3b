//! Cell by cell along the ray; for a ray from so far away that it may hit what lies beside its cells, slice by slice.

use glam::UVec3;

use super::lattice::bit_of;
use super::steps::{LatticeRay, Steps};
use super::{BLOCK, Block, Grid};
use crate::accel::leaf::{Kept, Query, test_each};
use crate::accel::listed::{Mailbox, test_listed};
use crate::accel::tally::Tally;
use crate::accel::walk_ray::{Span, WalkRay};
use crate::accel::{Primitive, Walk};
use crate::geometry::{PrecisionMode, Ray};

impl<T: Primitive> Walk for Grid<T> {
    type Primitive = T;

    #[inline(never)]
    fn walk<Q: Query, P: PrecisionMode, K: Kept<T>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        tally: &mut Q::Tally,
    ) -> Option<K> {
        let walk_ray = WalkRay::new(ray, &self.bounds);
        let span = walk_ray.span_in(&self.bounds, ray.t_min, ray.t_max)?;
        let mut search = Search::<T, Q, K> {
            grid: self,
            ray: T::make_ready(ray),
            t_min: ray.t_min,
            kept: K::begin(seed, ray),
            mailbox: Mailbox::EMPTY,
            tally,
        };
        if walk_ray.band <= self.lattice.widest_band {
            search.pass_blocks::<P>(&LatticeRay::new(&walk_ray, &self.lattice), span);
        } else if walk_ray.band >= self.lattice.extent() {
            search.test_all::<P>();
        } else {
            search.pass_slices::<P>(&walk_ray, span);
        }
        search.kept.found()
    }
}

struct Search<'a, T: Primitive, Q: Query, K> {
    grid: &'a Grid<T>,
    ray: T::Ray,
    t_min: f32,
    kept: K,
    mailbox: Mailbox,
    tally: &'a mut Q::Tally,
}

impl<T: Primitive, Q: Query, K: Kept<T>> Search<'_, T, Q, K> {
    /// The hit at the best `t` so far, or a better one, is in a cell that the ray is in at that `t`: once it leaves one
    /// later, all are found; but at the same `t` the next one may hold an equal hit with a lower id.
    #[inline(always)]
    fn is_over(&self, end: f64) -> bool {
        f64::from(self.kept.t_max()) < end
    }

    /// Through the blocks that the ray passes, and the cells of those that are not empty.
    #[inline(always)]
    fn pass_blocks<P: PrecisionMode>(&mut self, ray: &LatticeRay, span: Span) {
        let lattice = &self.grid.lattice;
        let mut begin = span.begin;
        let mut blocks = Steps::<BLOCK>::new(ray, begin, UVec3::ZERO, lattice.counts - 1);
        loop {
            let block = &self.grid.blocks[lattice.block_number(blocks.at())];
            let end = blocks.end();
            if block.occupied != 0 {
                let first = blocks.at() * BLOCK;
                let last = lattice.nearest(first + (BLOCK - 1));
                let cells = Steps::<1>::new(ray, begin, first, last);
                if self.pass_cells::<P>(block, cells) {
                    return;
                }
            }
            if self.is_over(end) || !blocks.advance() {
                return;
            }
            begin = end;
        }
    }

    /// True ends the query.
    #[inline(always)]
    fn pass_cells<P: PrecisionMode>(&mut self, block: &Block, mut cells: Steps<1>) -> bool {
        loop {
            if self.test_cell::<P>(block, cells.at()) || self.is_over(cells.end()) {
                return true;
            }
            if !cells.advance() {
                return false;
            }
        }
    }

    #[inline(always)]
    fn test_cell<P: PrecisionMode>(&mut self, block: &Block, cell: UVec3) -> bool {
        self.tally.step_cell();
        let list = self.grid.list(block, bit_of(cell));
        !list.is_empty()
            && test_listed::<Q, P, T, K>(
                list,
                &self.grid.primitives,
                &mut self.mailbox,
                (&self.ray, self.t_min),
                &mut self.kept,
                self.tally,
            )
    }

    /// What a band as wide as the scene asks for: each primitive once, instead of each cell.
    #[cold]
    fn test_all<P: PrecisionMode>(&mut self) {
        self.tally.test_primitives(self.grid.primitives.len());
        test_each::<Q, P, T, K>(&self.grid.primitives, &self.ray, self.t_min, &mut self.kept);
    }

    /// Through the slices of cells across the axis along which the ray passes the most, in each to all cells that it
    /// passes within the band.
    #[inline(never)]
    fn pass_slices<P: PrecisionMode>(&mut self, ray: &WalkRay, span: Span) {
        let lattice = &self.grid.lattice;
        let main = (ray.direction * lattice.per_length).abs().max_position();
        let last = lattice.counts - 1;
        let box_between = |begin: f64, end: f64| {
            let (a, b) = (ray.origin + ray.direction * begin, ray.origin + ray.direction * end);
            (lattice.cell_at(a.min(b) - ray.band), lattice.cell_at(a.max(b) + ray.band))
        };
        let (lower, upper) = box_between(span.begin, span.end);
        // By the sign of a zero too, where the ray runs along the only axes on which the scene is flat.
        let is_up = ray.inverse[main].is_sign_positive();
        for step in 0..=upper[main] - lower[main] {
            let slice = if is_up { lower[main] + step } else { upper[main] - step };
            // Of the border's slices everything beyond belongs to them.
            let plane = |slice: u32, band: f64| {
                (lattice.lower[main] + f64::from(slice) * lattice.size[main] + band - ray.origin[main])
                    * ray.inverse[main]
            };
            let (below, above) = (plane(slice, -ray.band), plane(slice + 1, ray.band));
            let (mut begin, mut end) = if is_up { (below, above) } else { (above, below) };
            let (is_lowest, is_highest) = (slice == 0, slice == last[main]);
            if if is_up { is_lowest } else { is_highest } {
                begin = span.begin;
            }
            if if is_up { is_highest } else { is_lowest } {
                end = span.end;
            }
            (begin, end) = (begin.max(span.begin), end.min(span.end));
            if f64::from(self.kept.t_max()) < begin {
                return;
            }
            if begin > end {
                continue;
            }
            let (mut first, mut last) = box_between(begin, end);
            (first[main], last[main]) = (slice, slice);
            for z in first.z..=last.z {
                for y in first.y..=last.y {
                    for x in first.x..=last.x {
                        let cell = UVec3::new(x, y, z);
                        let block = &self.grid.blocks[lattice.block_number(cell / BLOCK)];
                        if self.test_cell::<P>(block, cell) {
                            return;
                        }
                    }
                }
            }
        }
    }
}
