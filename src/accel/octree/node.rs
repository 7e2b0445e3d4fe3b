//! The tree as plain data.

/// Octants are numbered by three bits, 1 where it is the upper half along x, 2 along y, 4 along z. 8 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Where a leaf's primitives begin in the list, else the first child.
    pub(super) first: u32,
    /// [`HAS_CHILDREN`] and a bit for each octant that has anything, in whose order the children are; or how many
    /// primitives a leaf has.
    kind: u32,
}

const _: () = assert!(size_of::<Node>() == 8);

const HAS_CHILDREN: u32 = 1 << 31;

/// The cube and what it is cut into, down to cells of 2^-19 of its size: the band of a ray from within is a little less.
pub(super) const MOST_LEVELS: usize = 20;

impl Node {
    pub(super) const EMPTY: Self = Self { first: 0, kind: 0 };

    pub(super) fn leaf(first: usize, count: usize) -> Self {
        Self { first: first as u32, kind: count as u32 }
    }

    pub(super) fn with_children(first: usize, octants: u8) -> Self {
        Self { first: first as u32, kind: HAS_CHILDREN | u32::from(octants) }
    }

    #[inline(always)]
    pub(super) fn is_leaf(&self) -> bool {
        self.kind & HAS_CHILDREN == 0
    }

    /// The same among others, of which so many are before its own: lists, and nodes.
    pub(super) fn moved(self, list_base: u32, node_base: u32) -> Self {
        Self { first: self.first + if self.is_leaf() { list_base } else { node_base }, ..self }
    }

    /// Of a leaf.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.kind as usize
    }

    /// A bit for each octant with a child, numbered as they are seen from the octant `first`.
    #[inline(always)]
    pub(super) fn octants_from(&self, first: u32) -> u32 {
        let octants = self.kind & 0xFF;
        let swapped = |octants: u32, axis: u32, lower: u32| {
            let distance = (first >> axis & 1) << axis;
            // Nothing moves where the distance is 0.
            (octants & lower) << distance | (octants & !lower) >> distance
        };
        swapped(swapped(swapped(octants, 0, 0x55), 1, 0x33), 2, 0x0F)
    }

    #[cfg(any(test, debug_assertions))]
    pub(super) fn has_child(&self, octant: u32) -> bool {
        self.kind >> octant & 1 != 0
    }

    #[cfg(any(test, debug_assertions))]
    pub(super) fn child_count(&self) -> u32 {
        u32::from(self.kind as u8).count_ones()
    }

    /// The child in an octant that has one.
    #[inline(always)]
    pub(super) fn child(&self, octant: u32) -> u32 {
        self.first + (self.kind & ((1 << octant) - 1)).count_ones()
    }
}
