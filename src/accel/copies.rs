//! Primitives that are the same to the bit as another one, which stands for them in a structure.

/// Ids of a primitive: `(geometry_id, primitive_id)`.
pub(crate) type Ids = (u32, u32);

/// One that a structure does not store, beside the one that it stores in its place. 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Copied {
    pub(crate) stored: Ids,
    pub(crate) ids: Ids,
}

/// For each stored primitive those that it stands for. Few scenes have any.
#[derive(Default)]
pub(crate) struct Copies(Vec<Copied>);

impl Copies {
    /// What builders noted, in any order and maybe more than once.
    pub(crate) fn new(mut noted: Vec<Copied>) -> Self {
        noted.sort_unstable();
        noted.dedup();
        Self(noted)
    }

    /// Those that a stored primitive stands for, in their order.
    #[inline]
    pub(crate) fn of(&self, stored: Ids) -> impl Iterator<Item = Ids> {
        let first = self.0.partition_point(|copy| copy.stored < stored);
        self.0[first..].iter().take_while(move |copy| copy.stored == stored).map(|copy| copy.ids)
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_come_in_their_order_and_once() {
        let copy = |stored, ids| Copied { stored, ids };
        let noted = vec![copy((1, 0), (1, 9)), copy((0, 3), (2, 0)), copy((1, 0), (1, 4)), copy((1, 0), (1, 9))];
        let copies = Copies::new(noted);
        let of = |stored| copies.of(stored).collect::<Vec<_>>();
        assert_eq!(of((1, 0)), [(1, 4), (1, 9)]);
        assert_eq!(of((0, 3)), [(2, 0)]);
        assert_eq!(of((0, 4)), []);
        assert_eq!(copies.bytes(), 3 * 16);
    }
}
