//! Walks that keep more than the best hit: the scalar test looks at each primitive of a leaf that is not refused.

use std::marker::PhantomData;

use super::WideBvh;
use super::box_test::{AlongX, Oblique, Plain};
use super::leaf_test::{LeafTest, Place};
use super::leaves::LeafForm;
use super::node::Child;
use super::traverse::{Aligned, Keep, Stack, Walk};
use crate::accel::leaf::{AnyHit, Every, Kept, Query};
use crate::accel::{AllHits, Around};
use crate::geometry::{Accurate, ObliqueSlabs, PrecisionMode, Ray, SlabRay};
use crate::simd::{Scalar, Simd, SimdKernel};

/// Keeps of a leaf's primitives what the ray may hit; if `LOOKS_AT_ALL`, whatever is there.
struct Each<'a, F, K, const LOOKS_AT_ALL: bool> {
    bvh: &'a WideBvh<F>,
    kept: K,
}

impl<F: LeafForm, K: Kept<F::Primitive>, const LOOKS_AT_ALL: bool> Keep<F> for Each<'_, F, K, LOOKS_AT_ALL> {
    #[inline(always)]
    fn t_max(&self) -> f32 {
        self.kept.t_max()
    }

    #[inline(always)]
    fn test_leaf<Q: Query, P: PrecisionMode, S: Simd>(
        &mut self,
        leaves: &F::Test<'_>,
        simd: S,
        child: Child,
        t_max: f32,
    ) -> bool {
        let (_, count) = child.triangles();
        let mut left = if LOOKS_AT_ALL { (1 << count) - 1 } else { leaves.lanes::<P, S>(simd, child, t_max) };
        while left != 0 {
            let lane = left.trailing_zeros();
            left &= left - 1;
            let primitive = self.bvh.leaves.with_own_ids(Place::new(child, lane).primitive(self.bvh));
            if self.kept.test::<Q, P>(&primitive, leaves.ray(), leaves.t_min()) {
                return true;
            }
        }
        false
    }
}

impl<F: LeafForm> WideBvh<F> {
    /// Offers all hits of a valid ray, roughly in their order.
    pub(super) fn offer_hits<P: PrecisionMode, S: Simd>(&self, simd: S, ray: &Ray, all: &mut AllHits<F::Primitive>) {
        simd.vectorize_batch(OfferHits { bvh: self, ray, all, precision: PhantomData::<P> });
    }

    /// Shows what the half-line along +x from a point may cross.
    pub(super) fn look_around(&self, around: &mut Around) {
        let (ray, boxes) = (around.ray(), AlongX::new(around.point()));
        let each = Each::<F, _, true> { bvh: self, kept: around };
        let mut stack = Aligned(Stack::new_const());
        let leaves = F::Test::new::<Accurate>(self, &ray);
        let mut walk = Walk::<AnyHit, F, _>::new(self, &leaves, &mut stack.0, each);
        walk.run_from_root::<Accurate, _, _>(Scalar, &boxes);
    }
}

struct OfferHits<'a, 'c, F: LeafForm, P> {
    bvh: &'a WideBvh<F>,
    ray: &'a Ray,
    all: &'a mut AllHits<'c, F::Primitive>,
    precision: PhantomData<P>,
}

impl<F: LeafForm, P: PrecisionMode> SimdKernel for OfferHits<'_, '_, F, P> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { bvh, ray, all, .. } = self;
        let mut stack = Aligned(Stack::new_const());
        let mut leaves = F::Test::new::<P>(bvh, ray);
        let each = Each::<F, _, false> { bvh, kept: all };
        match ObliqueSlabs::new(ray, &bvh.corners) {
            Some(slabs) => {
                let mut walk = Walk::<Every, F, _>::new(bvh, &leaves, &mut stack.0, each);
                walk.run_from_root::<P, S, _>(simd, &Oblique::new(slabs))
            }
            None => {
                leaves.check_range();
                let mut walk = Walk::<Every, F, _>::new(bvh, &leaves, &mut stack.0, each);
                walk.run_from_root::<P, S, _>(simd, &Plain::new(SlabRay::new(ray, &bvh.bounds), ray.t_min))
            }
        };
    }
}
