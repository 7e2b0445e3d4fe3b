//! No structure: every primitive is asked. The fastest for a handful, and the answer that the others are held against.

use super::leaf::{Kept, Query, test_each};
use super::stats::Shape;
use super::tally::Tally;
use super::{BuildContext, BuildFailure, Primitive, Walk};
use crate::geometry::{PrecisionMode, Ray};

pub(crate) struct BruteForce<T> {
    primitives: Vec<T>,
}

impl<T: Primitive> BruteForce<T> {
    pub(crate) fn build(primitives: Vec<T>, context: &BuildContext) -> Result<Self, BuildFailure> {
        context.check()?;
        Ok(Self { primitives })
    }

    /// Each once.
    pub(super) fn primitives(&self) -> &[T] {
        &self.primitives
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape {
            reference_count: self.primitives.len(),
            node_count: 0,
            leaf_count: 0,
            depth: 0,
            node_bytes: 0,
            leaf_bytes: size_of_val(self.primitives.as_slice()),
            sah_cost: self.primitives.len() as f64,
        }
    }
}

impl<T: Primitive> Walk for BruteForce<T> {
    type Primitive = T;

    fn is_empty(&self) -> bool {
        self.primitives.is_empty()
    }

    /// Inlined: out of line a hit goes through memory, and one triangle takes a third longer.
    #[inline(always)]
    fn walk<Q: Query, P: PrecisionMode, K: Kept<T>>(
        &self,
        ray: &Ray,
        seed: K::Seed,
        tally: &mut Q::Tally,
    ) -> Option<K> {
        tally.test_primitives(self.primitives.len());
        let mut kept = K::begin(seed, ray);
        test_each::<Q, P, T, K>(&self.primitives, &T::make_ready(ray), ray.t_min, &mut kept);
        kept.found()
    }
}
