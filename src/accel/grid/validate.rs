//! What a walk relies on, checked after every build in debug builds and tests.

use super::cells::CellBox;
use super::lattice::bit_of;
use super::{BLOCK, Grid};
use crate::accel::Primitive;

impl<T: Primitive> Grid<T> {
    /// Every list is in its place, and every primitive is listed in each cell that it overlaps.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let (lattice, mut lists) = (&self.lattice, 0);
        for (number, block) in self.blocks.iter().enumerate() {
            if block.first_list != lists {
                return Err(format!("the lists of block {number} begin with {}, not {lists}", block.first_list));
            }
            lists += block.occupied.count_ones();
        }
        if self.blocks.len() != lattice.block_count() || self.starts.len() != lists as usize + 1 {
            return Err(format!("{} blocks and {} lists instead of {lists}", self.blocks.len(), self.starts.len()));
        }
        let is_in_order = self.starts.is_sorted_by(|a, b| a < b);
        if !is_in_order || self.starts[lists as usize] as usize != self.listed.len() {
            return Err("a list is empty, or ends outside of all".to_owned());
        }
        if let Some(number) = self.listed.iter().find(|&&number| number as usize >= self.primitives.len()) {
            return Err(format!("no primitive {number}"));
        }
        for (number, primitive) in self.primitives.iter().enumerate() {
            let mut missing = None;
            let around = CellBox::around(primitive, lattice);
            // What lies below the box around it by rounding alone is in the margin.
            around.for_each(&mut |cell| {
                let (lower, upper) = lattice.corners(cell, cell);
                let list = self.list(&self.blocks[lattice.block_number(cell / BLOCK)], bit_of(cell));
                if primitive.overlaps(lower, upper) && list.binary_search(&(number as u32)).is_err() {
                    missing = Some(cell);
                }
            });
            if let Some(cell) = missing {
                return Err(format!("primitive {number} is not listed in cell {cell}"));
            }
        }
        Ok(())
    }
}
