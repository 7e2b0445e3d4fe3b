//! Primitives that are the same to the bit as another one, which stands for them in a structure.

use super::{BuildContext, BuildFailure};

/// Ids of a primitive: `(geometry_id, primitive_id)`.
pub(crate) type Ids = (u32, u32);

/// One that a structure does not store, beside the one that it stores in its place. 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Copied {
    pub(crate) stored: Ids,
    pub(crate) ids: Ids,
}

/// For each stored primitive those that it stands for, and the reverse. Few scenes have any.
#[derive(Default)]
pub(crate) struct Copies {
    by_stored: Vec<Copied>,
    by_ids: Vec<Copied>,
}

impl Copies {
    /// What builders noted, in any order and maybe more than once.
    pub(crate) fn new(mut noted: Vec<Copied>, context: &BuildContext) -> Result<Self, BuildFailure> {
        noted.sort_unstable();
        noted.dedup();
        let mut by_ids = context.reserve(noted.len())?;
        by_ids.extend_from_slice(&noted);
        by_ids.sort_unstable_by_key(|copy: &Copied| copy.ids);
        Ok(Self { by_stored: noted, by_ids })
    }

    /// The one that stands for a primitive: mostly itself.
    pub(crate) fn stored(&self, ids: Ids) -> Ids {
        self.by_ids.binary_search_by_key(&ids, |copy| copy.ids).map_or(ids, |found| self.by_ids[found].stored)
    }

    /// Those that a stored primitive stands for, in their order.
    #[inline]
    pub(crate) fn of(&self, stored: Ids) -> impl Iterator<Item = Ids> {
        let first = self.by_stored.partition_point(|copy| copy.stored < stored);
        self.by_stored[first..].iter().take_while(move |copy| copy.stored == stored).map(|copy| copy.ids)
    }

    pub(crate) fn bytes(&self) -> usize {
        2 * size_of_val(self.by_stored.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Watch;
    use crate::simd::Isa;

    #[test]
    fn copies_come_in_their_order_and_once() {
        let copy = |stored, ids| Copied { stored, ids };
        let noted = vec![copy((1, 0), (1, 9)), copy((0, 3), (2, 0)), copy((1, 0), (1, 4)), copy((1, 0), (1, 9))];
        let watch = Watch::default();
        let context = BuildContext::new(None, None, Isa::Auto, &watch);
        let copies = Copies::new(noted, &context).expect("there is memory for three");
        let of = |stored| copies.of(stored).collect::<Vec<_>>();
        assert_eq!(of((1, 0)), [(1, 4), (1, 9)]);
        assert_eq!(of((0, 3)), [(2, 0)]);
        assert_eq!(of((0, 4)), []);
        assert_eq!([(1, 9), (2, 0), (0, 3), (0, 4)].map(|ids| copies.stored(ids)), [(1, 0), (0, 3), (0, 3), (0, 4)]);
        assert_eq!(copies.bytes(), 2 * 3 * 16);
    }
}
