//! Where planes are: those of a fixed direction by a number, others by a normal.

use glam::DVec3;

use crate::accel::space_tree::{ANY, Split};
#[cfg(any(test, debug_assertions))]
use crate::accel::space_tree::{Node, Plane};

pub(super) const DIRECTION_COUNT: usize = 13;

/// To the faces, edges and corners of a cube. Of whole numbers, so that heights of `f32` coordinates hardly round.
pub(super) const DIRECTIONS: [DVec3; DIRECTION_COUNT] = [
    DVec3::X,
    DVec3::Y,
    DVec3::Z,
    DVec3::new(1.0, 1.0, 0.0),
    DVec3::new(1.0, -1.0, 0.0),
    DVec3::new(1.0, 0.0, 1.0),
    DVec3::new(1.0, 0.0, -1.0),
    DVec3::new(0.0, 1.0, 1.0),
    DVec3::new(0.0, 1.0, -1.0),
    DVec3::new(1.0, 1.0, 1.0),
    DVec3::new(1.0, 1.0, -1.0),
    DVec3::new(1.0, -1.0, 1.0),
    DVec3::new(1.0, -1.0, -1.0),
];

const _: () = assert!(DIRECTION_COUNT <= ANY as usize);

/// Normal and distance.
pub(super) fn normal_and_distance(split: &Split) -> (DVec3, f64) {
    match *split {
        Split::Fixed { direction, position, .. } => (DIRECTIONS[direction as usize], f64::from(position)),
        Split::Any(plane) => plane.normal_and_distance(),
    }
}

/// How high above the plane a point is, in lengths of the normal.
#[inline(always)]
pub(super) fn height_of(split: &Split) -> impl Fn(DVec3) -> f64 + Copy + use<> {
    let (normal, distance) = normal_and_distance(split);
    move |point| normal.dot(point) - distance
}

/// How much higher a point is that is 1 further along each axis, at most.
#[inline(always)]
pub(super) fn length_of(split: &Split) -> f64 {
    normal_and_distance(split).0.abs().element_sum()
}

#[cfg(any(test, debug_assertions))]
pub(super) fn plane_of(node: Node, planes: &[Plane]) -> (DVec3, f64) {
    match node.kind() {
        ANY => planes[node.plane()].normal_and_distance(),
        direction => (DIRECTIONS[direction as usize], f64::from(node.position())),
    }
}
