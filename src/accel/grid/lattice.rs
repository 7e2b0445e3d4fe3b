//! Where cells are: planes at equal distances along each axis.

use glam::{DVec3, UVec3};

use super::BLOCK;
use crate::geometry::Aabb;
use crate::math::gamma;

/// How far from the scene's box, in its largest extents, a ray may begin whose walk visits only the cells that it passes.
const REACH: f64 = 8.0;

/// Along an axis. The margin then is at most a tenth of a cell.
const MOST_ALONG_AXIS: f64 = 8192.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    pub(super) lower: DVec3,
    /// Of a cell.
    pub(super) size: DVec3,
    /// `1 / size`; 0 along an axis on which the scene is flat, so that everything is in its one cell.
    pub(super) per_length: DVec3,
    /// Cells along each axis, at least 1.
    pub(super) counts: UVec3,
    pub(super) block_counts: UVec3,
    /// How far the numbers of blocks are apart along each axis; the most along the longest, so that the blocks of a layer
    /// follow each other.
    pub(super) strides: UVec3,
    /// A primitive is listed in the cells that are nearer to it than this along each axis.
    pub(super) margin: f64,
    /// The largest band of a ray that visits only the cells which it passes.
    ///
    /// A hit's point lies within the band of `R(t)` along each axis, so its primitive is listed wherever `R(t)` may be taken
    /// to be, if the margin exceeds the band by what rounding can do. One `gamma(24)` of the largest extent is left for that.
    /// With `v = 2^-53`, `e` an axis' extent, `M` the largest distance to a corner, at most `REACH e`: planes are off by
    /// `4 v (|lower| + e)`, and as coordinates are `f32`, `|lower| < 2^24 e` unless the axis is flat and has no planes; the
    /// walk's own distances are off by `8 v M`. Both are below 2^-26 of the extent.
    pub(super) widest_band: f64,
}

impl Lattice {
    /// Of about so many cells, as nearly cubes as whole numbers allow.
    pub(super) fn new(bounds: &Aabb, cell_count: f64) -> Self {
        let lower = bounds.lower.as_dvec3();
        let extent = bounds.upper.as_dvec3() - lower;
        let counts = cells_along(extent, cell_count.max(1.0));
        let size = extent / counts.as_dvec3();
        let per_length = DVec3::select(extent.cmpgt(DVec3::ZERO), size.recip(), DVec3::ZERO);
        let block_counts = (counts + (BLOCK - 1)) / BLOCK;
        let widest_band = f64::from(gamma(24)) * REACH * extent.max_element();
        Self {
            lower,
            size,
            per_length,
            counts,
            block_counts,
            strides: strides(block_counts),
            margin: widest_band + widest_band / REACH,
            widest_band,
        }
    }

    pub(super) fn cell_count(&self) -> usize {
        self.counts.to_array().iter().map(|&count| count as usize).product()
    }

    /// The largest of the scene.
    #[inline(always)]
    pub(super) fn extent(&self) -> f64 {
        (self.size * self.counts.as_dvec3()).max_element()
    }

    pub(super) fn block_count(&self) -> usize {
        self.block_counts.element_product() as usize
    }

    /// The axis along which the most blocks lie.
    pub(super) fn longest_axis(&self) -> usize {
        self.strides.max_position()
    }

    /// The cells in which a point may be; those at the border have everything beyond it.
    #[inline(always)]
    pub(super) fn cell_at(&self, point: DVec3) -> UVec3 {
        self.nearest(((point - self.lower) * self.per_length).max(DVec3::ZERO).as_uvec3())
    }

    #[inline(always)]
    pub(super) fn nearest(&self, cell: UVec3) -> UVec3 {
        cell.min(self.counts - 1)
    }

    /// The corners of a box of cells, both of which belong to it, with the margin.
    #[inline(always)]
    pub(super) fn corners(&self, first: UVec3, last: UVec3) -> (DVec3, DVec3) {
        let plane = |cell: UVec3| self.lower + cell.as_dvec3() * self.size;
        (plane(first) - self.margin, plane(last + 1) + self.margin)
    }

    #[inline(always)]
    pub(super) fn block_number(&self, block: UVec3) -> usize {
        let [x, y, z] = (block * self.strides).to_array();
        (x + y + z) as usize
    }
}

/// Which bit of its block's mask is the cell's.
#[inline(always)]
pub(super) fn bit_of(cell: UVec3) -> u32 {
    let [x, y, z] = (cell % BLOCK).to_array();
    x + BLOCK * y + BLOCK * BLOCK * z
}

/// An axis shorter than a cell has one; the others share the rest.
fn cells_along(extent: DVec3, cell_count: f64) -> UVec3 {
    let mut is_cut = extent.to_array().map(|extent| extent > 0.0);
    loop {
        let axes = || (0..3).filter(|&axis| is_cut[axis]);
        let dimension = axes().count();
        if dimension == 0 {
            return UVec3::ONE;
        }
        // Roots first: the product of three extents of tiny or huge scenes is in the range of f64, but only just.
        let root = |value: f64| value.powf(1.0 / dimension as f64);
        let size = axes().map(|axis| root(extent[axis])).product::<f64>() / root(cell_count);
        let Some(short) = axes().find(|&axis| extent[axis] < size) else {
            let along = |axis: usize| {
                if is_cut[axis] { (extent[axis] / size).round().clamp(1.0, MOST_ALONG_AXIS) as u32 } else { 1 }
            };
            return UVec3::new(along(0), along(1), along(2));
        };
        is_cut[short] = false;
    }
}

fn strides(block_counts: UVec3) -> UVec3 {
    let mut axes = [0, 1, 2];
    axes.sort_by_key(|&axis| block_counts[axis]);
    let mut strides = UVec3::ONE;
    let mut stride = 1;
    for axis in axes {
        strides[axis] = stride;
        stride *= block_counts[axis];
    }
    strides
}
