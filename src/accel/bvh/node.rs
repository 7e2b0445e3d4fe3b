//! The tree as plain data.

use crate::accel::reference::Bounds8;
use crate::geometry::Aabb;

/// 32 bytes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::accel) struct Node {
    /// `[lower, upper]` for each axis.
    pub(in crate::accel) planes: [[f32; 2]; 3],
    /// A leaf's first triangle, else the pair of children.
    pub(in crate::accel) first: u32,
    /// How many triangles a leaf has; 0 for a node with children.
    pub(in crate::accel) count: u32,
}

/// Two siblings: 64 bytes, one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(in crate::accel) struct NodePair {
    pub(in crate::accel) children: [Node; 2],
}

const _: () = assert!(size_of::<Node>() == 32);
const _: () = assert!(size_of::<NodePair>() == 64);

/// The most levels that a builder makes, and so what a traversal's stack holds: one sibling a level.
pub(in crate::accel) const MOST_LEVELS: usize = 96;

impl Node {
    pub(in crate::accel) fn new(bounds: &Aabb, first: u32, count: u32) -> Self {
        let (lower, upper) = (bounds.lower.to_array(), bounds.upper.to_array());
        Self { planes: std::array::from_fn(|axis| [lower[axis], upper[axis]]), first, count }
    }

    pub(in crate::accel) fn bounds8(&self) -> Bounds8 {
        let [x, y, z] = self.planes;
        Bounds8([x[0], y[0], z[0], 0.0, -x[1], -y[1], -z[1], 0.0])
    }

    pub(in crate::accel) fn is_leaf(&self) -> bool {
        self.count != 0
    }

    /// Half the surface of the box, in `f64` so that no scene overflows it.
    pub(in crate::accel) fn half_area(&self) -> f64 {
        let [x, y, z] = self.planes.map(|[lower, upper]| f64::from(upper) - f64::from(lower));
        x * y + y * z + z * x
    }
}

impl NodePair {
    pub(in crate::accel) const EMPTY: Self = Self { children: [Node { planes: [[0.0; 2]; 3], first: 0, count: 0 }; 2] };
}
