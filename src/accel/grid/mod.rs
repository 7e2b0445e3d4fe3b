//! Uniform grid: the scene's box cut into equal cells, each with a list of the primitives that overlap it (Fujimoto,
//! Tanaka, Iwata 1986, "ARTS: Accelerated ray-tracing system").
//!
//! Shines on primitives of one size that are evenly spread: nothing is built faster. Fails where sizes differ much: cells
//! that suit a stadium hold a teapot whole.

mod build;
mod cells;
mod lattice;
mod steps;
mod traverse;
#[cfg(any(test, debug_assertions))]
mod validate;

use lattice::Lattice;

use super::along_curve::gather_along_curve;
use super::reference::{PrimitiveSource, Reference};
use super::stats::Shape;
use super::{BuildContext, BuildFailure, Primitive, Quality};
use crate::geometry::Aabb;

/// So many cells along each axis are a block.
const BLOCK: u32 = 4;

/// 64 cells, a bit for each: an empty block is passed in one step. 16 bytes.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    /// Bit `x + 4 y + 16 z` where that cell's list is not empty.
    occupied: u64,
    /// The number of its first list; those of its occupied cells follow each other.
    first_list: u32,
}

const _: () = assert!(size_of::<Block>() == 16);

pub(crate) struct Grid<T> {
    bounds: Aabb,
    lattice: Lattice,
    blocks: Vec<Block>,
    /// Where each list begins in `listed`; and the end of the last one.
    starts: Vec<u32>,
    /// Numbers of primitives, in ascending order in each list.
    listed: Vec<u32>,
    primitives: Vec<T>,
    sah_cost: f64,
}

impl<T: Primitive> Grid<T> {
    /// At least one reference; `bounds` contains them all. `cells_per_primitive` is 0 for what suits the quality.
    pub(crate) fn build(
        references: Vec<Reference>,
        bounds: Aabb,
        cells_per_primitive: f32,
        quality: Quality,
        source: &impl PrimitiveSource<Primitive = T>,
        context: &BuildContext,
    ) -> Result<Self, BuildFailure> {
        context.expect(2 * references.len());
        let primitives = gather_along_curve(references, &bounds, source, context)?;
        let cells_per_primitive = match (cells_per_primitive, quality) {
            (asked, _) if asked > 0.0 => asked,
            (_, Quality::Low) => 2.0,
            (_, Quality::Medium) => 6.0,
            (_, Quality::High) => 12.0,
        };
        let lattice = build::choose_lattice(&primitives, &bounds, f64::from(cells_per_primitive), context)?;
        let grid = build::build(primitives, bounds, lattice, context)?;
        #[cfg(any(test, debug_assertions))]
        grid.validate().expect("a builder keeps the grid's invariants");
        Ok(grid)
    }

    /// Each once.
    pub(super) fn primitives(&self) -> &[T] {
        &self.primitives
    }

    /// A cell counts as a leaf.
    pub(crate) fn shape(&self) -> Shape {
        let cell_count = self.lattice.cell_count();
        Shape {
            reference_count: self.listed.len(),
            node_count: cell_count,
            leaf_count: cell_count,
            depth: 1,
            node_bytes: size_of_val(self.blocks.as_slice()) + size_of_val(self.starts.as_slice()),
            leaf_bytes: size_of_val(self.listed.as_slice()) + size_of_val(self.primitives.as_slice()),
            sah_cost: self.sah_cost,
        }
    }

    /// The primitives listed in the cell of a block that the bit stands for.
    #[inline(always)]
    fn list(&self, block: &Block, bit: u32) -> &[u32] {
        if block.occupied >> bit & 1 == 0 {
            return &[];
        }
        let number = block.first_list + (block.occupied & ((1 << bit) - 1)).count_ones();
        let ends = &self.starts[number as usize..][..2];
        &self.listed[ends[0] as usize..ends[1] as usize]
    }
}
