//! The tree as plain data.

/// 8 bytes: the field's figure for kd-trees (Pharr, Jakob, Humphreys, "Physically Based Rendering", section 4.4.1).
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(in crate::accel) struct Node {
    /// A leaf's first place in the lists, else the bits of where the plane is, or its number where the kind is [`ANY`].
    value: u32,
    /// The kind in the lowest bits; above it the pair of children, or how many primitives a leaf lists.
    word: u32,
}

/// Two siblings: the one below the plane, the one above.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(in crate::accel) struct NodePair {
    pub(in crate::accel) children: [Node; 2],
}

const _: () = assert!(size_of::<Node>() == 8);
const _: () = assert!(size_of::<NodePair>() == 16);

const KIND_BITS: u32 = 4;
/// The kinds below are numbers of fixed directions; a plane of any other direction stands in a table.
pub(in crate::accel) const ANY: u32 = 14;
const LEAF: u32 = 15;

/// How many pairs a tree may have, and primitives a leaf: what is left beside the kind.
pub(in crate::accel) const MOST_PAIRS: usize = 1 << (32 - KIND_BITS);

/// The most levels that a builder makes, and so what a traversal's stack holds: one sibling a level.
pub(in crate::accel) const MOST_LEVELS: usize = 64;

impl Node {
    pub(in crate::accel) const EMPTY_LEAF: Self = Self { value: 0, word: LEAF };

    pub(super) fn leaf(first: usize, count: usize) -> Self {
        Self { value: first as u32, word: (count as u32) << KIND_BITS | LEAF }
    }

    pub(super) fn inner(kind: u32, value: u32, pair: usize) -> Self {
        Self { value, word: (pair as u32) << KIND_BITS | kind }
    }

    #[inline(always)]
    pub(in crate::accel) fn is_leaf(self) -> bool {
        self.kind() == LEAF
    }

    #[inline(always)]
    pub(in crate::accel) fn kind(self) -> u32 {
        self.word % (1 << KIND_BITS)
    }

    /// The number in the table, of a node of kind [`ANY`].
    #[inline(always)]
    pub(in crate::accel) fn plane(self) -> usize {
        self.value as usize
    }

    /// Where the plane is, of a node of a fixed direction.
    #[inline(always)]
    pub(in crate::accel) fn position(self) -> f32 {
        f32::from_bits(self.value)
    }

    #[inline(always)]
    pub(in crate::accel) fn pair(self) -> usize {
        (self.word >> KIND_BITS) as usize
    }

    /// A leaf's part of the lists.
    #[inline(always)]
    pub(in crate::accel) fn list(self) -> std::ops::Range<usize> {
        let first = self.value as usize;
        first..first + (self.word >> KIND_BITS) as usize
    }

    /// The same node of a tree that follows others, by what those have.
    pub(super) fn after(self, pairs: usize, planes: usize, listed: usize) -> Self {
        match self.kind() {
            LEAF => Self { value: self.value + listed as u32, ..self },
            ANY => Self { value: self.value + planes as u32, word: self.word + ((pairs as u32) << KIND_BITS) },
            _ => Self { word: self.word + ((pairs as u32) << KIND_BITS), ..self },
        }
    }
}

impl NodePair {
    pub(super) const EMPTY: Self = Self { children: [Node::EMPTY_LEAF; 2] };
}
