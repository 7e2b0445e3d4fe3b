//! Where a node is.

use glam::{DVec3, UVec3};

use crate::accel::Primitive;
use crate::geometry::Aabb;

/// What the root is. Contains the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cube {
    pub(super) lower: DVec3,
    pub(super) size: f64,
}

/// A cube's part by whole numbers, so that no plane is off by more than one computation is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Where its middle is from the lower corner of all, counted in halves of its own size; all odd.
    pub(super) middle: UVec3,
    pub(super) half: f64,
}

impl Cube {
    pub(super) fn around(bounds: &Aabb) -> Self {
        let lower = bounds.lower.as_dvec3();
        Self { lower, size: (bounds.upper.as_dvec3() - lower).max_element() }
    }

    pub(super) fn whole(&self) -> Cell {
        Cell { middle: UVec3::ONE, half: 0.5 * self.size }
    }

    /// The lower corner, the middle and the upper corner.
    fn planes(&self, cell: &Cell) -> [DVec3; 3] {
        [cell.middle - 1, cell.middle, cell.middle + 1].map(|numbers| self.lower + numbers.as_dvec3() * cell.half)
    }

    #[cfg(any(test, debug_assertions))]
    pub(super) fn overlaps<T: Primitive>(&self, cell: &Cell, primitive: &T) -> bool {
        let [lower, _, upper] = self.planes(cell);
        primitive.overlaps(lower, upper)
    }
}

impl Cell {
    #[inline(always)]
    pub(super) fn octant(&self, octant: u32) -> Self {
        let is_upper = UVec3::new(octant & 1, octant >> 1 & 1, octant >> 2 & 1);
        Self { middle: 2 * (self.middle + is_upper) - 1, half: 0.5 * self.half }
    }
}

/// A cell about to be cut.
pub(super) struct Cut {
    lower: DVec3,
    middle: DVec3,
    upper: DVec3,
}

impl Cut {
    pub(super) fn new(cube: &Cube, cell: &Cell) -> Self {
        let [lower, middle, upper] = cube.planes(cell);
        Self { lower, middle, upper }
    }

    /// A bit for each octant that a primitive of the cell overlaps.
    #[inline(always)]
    pub(super) fn octants_of<T: Primitive>(&self, primitive: &T) -> u8 {
        /// The octants in the lower half along each axis.
        const LOWER: [u8; 3] = [0b0101_0101, 0b0011_0011, 0b0000_1111];

        let bounds = primitive.bounds();
        let (least, most) = (bounds.lower.as_dvec3().to_array(), bounds.upper.as_dvec3().to_array());
        let mut octants = u8::MAX;
        for (axis, lower_half) in LOWER.into_iter().enumerate() {
            if least[axis] > self.middle[axis] {
                octants &= !lower_half;
            }
            if most[axis] < self.middle[axis] {
                octants &= lower_half;
            }
        }
        if octants.is_power_of_two() {
            return octants;
        }
        let mut overlapped = octants;
        for octant in (0..8).filter(|octant| octants >> octant & 1 != 0) {
            let is_upper = glam::BVec3::new(octant & 1 != 0, octant & 2 != 0, octant & 4 != 0);
            let lower = DVec3::select(is_upper, self.middle, self.lower);
            let upper = DVec3::select(is_upper, self.upper, self.middle);
            if !primitive.overlaps(lower, upper) {
                overlapped &= !(1 << octant);
            }
        }
        overlapped
    }
}
