//! The cells that a primitive overlaps.

use glam::UVec3;

use super::lattice::Lattice;
use crate::accel::Primitive;

/// Cells from `first` to `last`, both among them.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellBox {
    pub(super) first: UVec3,
    pub(super) last: UVec3,
}

impl CellBox {
    /// Those that the primitive's box, with the margin, reaches.
    pub(super) fn around<T: Primitive>(primitive: &T, lattice: &Lattice) -> Self {
        let bounds = primitive.bounds();
        Self {
            first: lattice.cell_at(bounds.lower.as_dvec3() - lattice.margin),
            last: lattice.cell_at(bounds.upper.as_dvec3() + lattice.margin),
        }
    }

    /// Along each axis, one less than the number of cells.
    fn span(&self) -> UVec3 {
        self.last - self.first
    }

    /// About how many of its cells the primitive overlaps that it is around: a plane passes no more than one cell of each
    /// row along one of the axes and its neighbours.
    pub(super) fn estimate(&self) -> f64 {
        let [x, y, z] = (self.span() + 1).as_dvec3().to_array();
        (x * y).max(y * z).max(z * x)
    }

    /// The layers of blocks across `axis` in which it lies.
    pub(super) fn layers(&self, axis: usize) -> std::ops::RangeInclusive<u32> {
        self.first[axis] / super::BLOCK..=self.last[axis] / super::BLOCK
    }

    /// Hands over those cells of the box around the primitive that it overlaps, of those in the layer.
    pub(super) fn for_each_overlapped<T: Primitive>(
        self,
        primitive: &T,
        lattice: &Lattice,
        (axis, layer): (usize, u32),
        then: &mut impl FnMut(UVec3),
    ) {
        let mut part = self;
        part.first[axis] = part.first[axis].max(layer * super::BLOCK);
        part.last[axis] = part.last[axis].min(layer * super::BLOCK + super::BLOCK - 1);
        // A primitive is in one piece and touches all sides of its box: in a row of cells it is in each.
        if self.span().to_array().iter().filter(|&&span| span > 0).count() <= 1 {
            part.for_each(then);
        } else {
            part.halve_until_sure(primitive, lattice, then);
        }
    }

    /// Parts that the primitive does not overlap are left out whole.
    fn halve_until_sure<T: Primitive>(self, primitive: &T, lattice: &Lattice, then: &mut impl FnMut(UVec3)) {
        let (lower, upper) = lattice.corners(self.first, self.last);
        let span = self.span();
        if span.max_element() > 1 {
            if primitive.overlaps(lower, upper) {
                let axis = span.max_position();
                let (mut near, mut far) = (self, self);
                near.last[axis] = self.first[axis] + span[axis] / 2;
                far.first[axis] = near.last[axis] + 1;
                near.halve_until_sure(primitive, lattice, then);
                far.halve_until_sure(primitive, lattice, then);
            }
            return;
        }
        self.for_each(&mut |cell| {
            let (lower, upper) = lattice.corners(cell, cell);
            if primitive.overlaps(lower, upper) {
                then(cell);
            }
        });
    }

    pub(super) fn for_each(self, then: &mut impl FnMut(UVec3)) {
        for z in self.first.z..=self.last.z {
            for y in self.first.y..=self.last.y {
                for x in self.first.x..=self.last.x {
                    then(UVec3::new(x, y, z));
                }
            }
        }
    }
}
