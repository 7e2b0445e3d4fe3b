//! The tree as plain data.

use crate::simd::LANES;

/// A child: a node, or a leaf with its triangles.
///
/// Bit 31 says leaf. A leaf has the number of its triangles, less one, in bits 28 to 30, and its place below; a node its
/// index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const PLACE_BITS: u32 = 28;
    /// How many places of leaves 28 bits can tell apart.
    pub(super) const MOST_PLACES: usize = 1 << Self::PLACE_BITS;

    /// The node that everything is below.
    pub(super) const ROOT: Self = Self(0);

    /// No child. As a node it would be the last of more than there can be.
    pub(super) const NONE: Self = Self(Self::LEAF - 1);

    pub(super) fn node(index: usize) -> Self {
        debug_assert!(index < Self::NONE.0 as usize);
        Self(index as u32)
    }

    pub(super) fn leaf(place: usize, count: usize) -> Self {
        debug_assert!(place < Self::MOST_PLACES && (1..=LANES).contains(&count));
        Self(Self::LEAF | ((count as u32 - 1) << Self::PLACE_BITS) | place as u32)
    }

    #[inline(always)]
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    #[inline(always)]
    pub(super) const fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub(super) fn node_index(self) -> usize {
        self.0 as usize
    }

    /// A leaf's place and the number of its triangles.
    #[inline(always)]
    pub(super) fn triangles(self) -> (usize, usize) {
        let place = self.0 & ((1 << Self::PLACE_BITS) - 1);
        let count = ((self.0 >> Self::PLACE_BITS) & 7) + 1;
        (place as usize, count as usize)
    }
}

/// 256 bytes, four cache lines. An empty slot has a box that no ray meets, and any child.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct WideNode {
    /// `[lower, upper]` for each axis, eight children each.
    pub(super) planes: [[[f32; LANES]; 2]; 3],
    pub(super) children: [Child; LANES],
}

const _: () = assert!(size_of::<WideNode>() == 256);

impl WideNode {
    pub(super) const EMPTY: Self = Self {
        planes: [[[f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]]; 3],
        children: [Child(Child::LEAF); LANES],
    };

    /// The children's bits, to move as a register.
    #[inline(always)]
    pub(super) fn child_bits(&self) -> [u32; LANES] {
        self.children.map(Child::bits)
    }

    /// Those that are there.
    pub(super) fn children(&self) -> impl Iterator<Item = Child> {
        let [lower, upper] = &self.planes[0];
        (0..LANES).filter(|&slot| lower[slot] <= upper[slot]).map(|slot| self.children[slot])
    }

    pub(super) fn set(&mut self, slot: usize, planes: &[[f32; 2]; 3], child: Child) {
        for (axis, [lower, upper]) in planes.iter().enumerate() {
            self.planes[axis][0][slot] = *lower;
            self.planes[axis][1][slot] = *upper;
        }
        self.children[slot] = child;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaf_reference_holds_its_place_and_its_count_at_their_limits() {
        for place in [0, 1, Child::MOST_PLACES - 1] {
            for count in 1..=LANES {
                let child = Child::leaf(place, count);
                assert!(child.is_leaf());
                assert_eq!(child.triangles(), (place, count));
            }
        }
    }

    #[test]
    fn node_reference_holds_its_index_at_its_limits() {
        for index in [0, 1, Child::MOST_PLACES, (1 << 31) - 2] {
            let child = Child::node(index);
            assert!(!child.is_leaf());
            assert_eq!(child.node_index(), index);
        }
    }

    #[test]
    fn empty_slot_refers_to_triangles_that_are_there() {
        assert_eq!(WideNode::EMPTY.children, [Child::leaf(0, 1); LANES]);
    }
}
