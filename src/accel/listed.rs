//! Lists of primitives by number, where several cells list the same one.

use super::Primitive;
use super::leaf::{Kept, Query, test_each};
use super::tally::Tally;
use crate::geometry::PrecisionMode;

/// A power of two.
const PLACES: usize = 16;

/// What a ray was tested against last, so that it is not at once tested again (Arnaldi, Priol, Bouatouch 1987; Amanatides and
/// Woo 1987). That changes no answer: the same hit again changes nothing.
pub(super) struct Mailbox([u32; PLACES]);

impl Mailbox {
    /// `u32::MAX` numbers no primitive.
    pub(super) const EMPTY: Self = Self([u32::MAX; PLACES]);

    /// True the first time; maybe also later.
    #[inline(always)]
    fn put(&mut self, number: u32) -> bool {
        std::mem::replace(&mut self.0[number as usize % PLACES], number) != number
    }
}

/// [`test_each`] for those of a list that are not in the mailbox.
#[inline(never)]
pub(super) fn test_listed<Q: Query, P: PrecisionMode, T: Primitive, K: Kept<T>>(
    list: &[u32],
    primitives: &[T],
    mailbox: &mut Mailbox,
    (ray, t_min): (&T::Ray, f32),
    kept: &mut K,
    tally: &mut Q::Tally,
) -> bool {
    let untested = list.iter().filter(|&&number| mailbox.put(number)).map(|&number| {
        tally.test_primitives(1);
        &primitives[number as usize]
    });
    test_each::<Q, P, T, K>(untested, ray, t_min, kept)
}
