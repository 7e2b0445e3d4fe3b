//! From cell to cell along a ray: 3D-DDA (Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray tracing").

use glam::{DVec3, UVec3};

use super::lattice::Lattice;
use crate::accel::walk_ray::WalkRay;

/// A ray in a lattice: lengths are counted in cells, `t` is the ray's own.
#[derive(Clone, Copy)]
pub(super) struct LatticeRay {
    origin: DVec3,
    direction: DVec3,
    /// The plane `n` is met at `n * per_plane + offset`. No numbers along an axis on which the ray stays where it is.
    per_plane: DVec3,
    offset: DVec3,
}

impl LatticeRay {
    #[inline(always)]
    pub(super) fn new(ray: &WalkRay, lattice: &Lattice) -> Self {
        Self {
            origin: (ray.origin - lattice.lower) * lattice.per_length,
            direction: ray.direction * lattice.per_length,
            per_plane: ray.inverse * lattice.size,
            offset: (lattice.lower - ray.origin) * ray.inverse,
        }
    }

    /// The cell at `t`, or of those from `first` to `last` the nearest one.
    #[inline(always)]
    pub(super) fn cell_at(&self, t: f64, first: UVec3, last: UVec3) -> UVec3 {
        (self.origin + self.direction * t).max(DVec3::ZERO).as_uvec3().clamp(first, last)
    }
}

/// A walk through boxes of `SIZE` cells along each axis. Each distance is computed from the box's number, so that none
/// is off by more than one computation is.
pub(super) struct Steps<'r, const SIZE: u32> {
    ray: &'r LatticeRay,
    at: [u32; 3],
    /// Where the ray leaves the present box, axis by axis.
    leave: [f64; 3],
    /// 1, or -1 as it wraps around; 0 along an axis on which the ray stays where it is.
    step: [u32; 3],
    /// The first one outside; the present one where there is no step.
    outside: [u32; 3],
}

impl<'r, const SIZE: u32> Steps<'r, SIZE> {
    /// From where the ray is at `t`, among the boxes that have the cells from `first` to `last`.
    #[inline(always)]
    pub(super) fn new(ray: &'r LatticeRay, t: f64, first: UVec3, last: UVec3) -> Self {
        let at = (ray.cell_at(t, first, last) / SIZE).to_array();
        let (first, last) = ((first / SIZE).to_array(), (last / SIZE).to_array());
        let direction = ray.direction.to_array();
        let mut steps = Self { ray, at, leave: [f64::INFINITY; 3], step: [0; 3], outside: at };
        for axis in 0..3 {
            if direction[axis] > 0.0 {
                (steps.step[axis], steps.outside[axis]) = (1, last[axis] + 1);
            } else if direction[axis] < 0.0 {
                (steps.step[axis], steps.outside[axis]) = (u32::MAX, first[axis].wrapping_sub(1));
            } else {
                continue;
            }
            steps.leave[axis] = steps.leave_along(axis);
        }
        steps
    }

    #[inline(always)]
    fn leave_along(&self, axis: usize) -> f64 {
        // A step up crosses the upper plane.
        let plane = self.at[axis] + u32::from(self.step[axis] == 1);
        f64::from(plane * SIZE) * self.ray.per_plane[axis] + self.ray.offset[axis]
    }

    #[inline(always)]
    pub(super) fn at(&self) -> UVec3 {
        UVec3::from_array(self.at)
    }

    /// Where the ray leaves the present box.
    #[inline(always)]
    pub(super) fn end(&self) -> f64 {
        let [x, y, z] = self.leave;
        let least = if y < x { y } else { x };
        if z < least { z } else { least }
    }

    /// To the next box; false where there is none.
    #[inline(always)]
    pub(super) fn advance(&mut self) -> bool {
        let [x, y, z] = self.leave;
        // Written out axis by axis, so that a walk stays in registers.
        if x <= y {
            if x <= z { self.advance_along(0) } else { self.advance_along(2) }
        } else if y <= z {
            self.advance_along(1)
        } else {
            self.advance_along(2)
        }
    }

    #[inline(always)]
    fn advance_along(&mut self, axis: usize) -> bool {
        self.at[axis] = self.at[axis].wrapping_add(self.step[axis]);
        if self.at[axis] == self.outside[axis] {
            return false;
        }
        self.leave[axis] = self.leave_along(axis);
        true
    }
}
