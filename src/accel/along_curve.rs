//! Primitives in the order of a space-filling curve, each once: for structures that list them by number.

use rayon::prelude::*;

use super::morton::Curve;
use super::reference::{PrimitiveSource, Reference};
use super::{BuildContext, BuildFailure, Copied, Primitive};
use crate::geometry::Aabb;

/// Bits of a Morton code for each axis.
const BITS: u32 = 11;

/// Where a reference comes on the curve, and what it is at that place.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    /// The Morton code of the box's centre, and a hash of the box that is the same for primitives of the same shape.
    key: u64,
    /// In the order in which equal hits win.
    index: u32,
}

/// Of primitives that are the same to the bit the one whose hits win, all in Morton order (Morton 1966), so that what is
/// near in space is near in memory. References come in the order of their ids.
pub(super) fn gather_along_curve<S: PrimitiveSource>(
    references: Vec<Reference>,
    bounds: &Aabb,
    source: &S,
    context: &BuildContext,
) -> Result<Vec<S::Primitive>, BuildFailure> {
    let count = references.len();
    let curve = Curve::new(bounds, BITS);
    let key = |reference: &Reference| {
        curve.code(reference) << (64 - 3 * BITS) | u64::from(hash(reference) >> (3 * BITS - 32))
    };
    let mut places: Vec<Place> = context.reserve(count)?;
    context.collect_with(
        &mut places,
        count as u32,
        |_| (),
        |(), index| Place { key: key(&references[index as usize]), index },
    );
    if context.is_parallel() {
        places.par_sort_unstable();
    } else {
        places.sort_unstable();
    }
    context.advance(count)?;

    let shape = |place: &Place| references[place.index as usize].primitive(source).shape();
    places.dedup_by(|next, kept| {
        let is_copy = next.key == kept.key && shape(next) == shape(kept);
        if is_copy {
            let [stored, ids] = [kept, next].map(|place| references[place.index as usize].ids());
            context.note_copy(Copied { stored, ids });
        }
        is_copy
    });
    let mut primitives = context.reserve(places.len())?;
    let primitive = |(): &mut (), at: u32| references[places[at as usize].index as usize].primitive(source);
    context.collect_with(&mut primitives, places.len() as u32, |_| (), primitive);
    context.release(places);
    context.release(references);
    Ok(primitives)
}

/// A hash of its box, the same for primitives of the same shape.
fn hash(reference: &Reference) -> u32 {
    let Aabb { lower, upper } = reference.bounds().to_aabb();
    [lower, upper].iter().flat_map(|corner| corner.to_array()).fold(0, |hash: u32, coordinate| {
        // FNV-1a, a word at a time; of two zeros the positive one.
        (hash ^ (coordinate + 0.0).to_bits()).wrapping_mul(0x0100_0193).rotate_left(15)
    })
}
