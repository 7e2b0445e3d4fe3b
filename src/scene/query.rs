//! Queries: the one place where a scene's structure and precision are looked at, once a call.

use super::Scene;
use crate::accel::{Accel, AnyAccel, AnyHit, Closest, ClosestHit, Precision, Vectorized, WideBvh};
use crate::geometry::{Accurate, Fast, Hit, INVALID_ID, PrecisionMode, Ray};
#[cfg(target_arch = "x86_64")]
use crate::simd::{Avx2, Sse42};
use crate::simd::{Isa, Scalar};

/// Work that runs on whatever structure and precision a scene has.
pub(super) trait Kernel {
    type Output;
    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) -> Self::Output;
}

impl Scene {
    /// The closest hit of a ray, or [`Hit::MISS`].
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Hit {
        self.dispatch(Single(ClosestOf, ray))
    }

    /// Whether the ray hits anything.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.dispatch(Single(Occlusion, ray))
    }

    #[inline(always)]
    pub(super) fn dispatch<K: Kernel>(&self, kernel: K) -> K::Output {
        match &self.accel {
            AnyAccel::BruteForce(brute_force) => self.dispatch_precision(kernel, brute_force),
            AnyAccel::Bvh(bvh) => self.dispatch_precision(kernel, bvh),
            AnyAccel::WideBvh(bvh) => self.dispatch_isa(kernel, bvh),
        }
    }

    #[inline(always)]
    fn dispatch_isa<K: Kernel>(&self, kernel: K, bvh: &WideBvh) -> K::Output {
        #[cfg(target_arch = "x86_64")]
        {
            if let Some(simd) = Avx2::detect().filter(|_| self.isa == Isa::Avx2) {
                return self.dispatch_precision(kernel, &Vectorized { bvh, simd });
            }
            if let Some(simd) = Sse42::detect().filter(|_| self.isa == Isa::Sse42) {
                return self.dispatch_precision(kernel, &Vectorized { bvh, simd });
            }
        }
        self.dispatch_precision(kernel, &Vectorized { bvh, simd: Scalar })
    }

    #[inline(always)]
    fn dispatch_precision<K: Kernel, A: Accel + Sync>(&self, kernel: K, accel: &A) -> K::Output {
        match self.precision {
            Precision::Fast => kernel.run::<A, Fast>(accel),
            // An exact scene is not built yet.
            Precision::Accurate | Precision::Exact => kernel.run::<A, Accurate>(accel),
        }
    }
}

/// A question about one ray.
pub(super) trait Question: Copy + Sync {
    type Answer: Send;
    fn answer<A: Accel, P: PrecisionMode>(self, accel: &A, ray: &Ray) -> Self::Answer;
}

/// What does it hit first?
#[derive(Clone, Copy)]
pub(super) struct ClosestOf;

/// Does it hit anything?
#[derive(Clone, Copy)]
pub(super) struct Occlusion;

impl Question for ClosestOf {
    type Answer = Hit;

    #[inline(always)]
    fn answer<A: Accel, P: PrecisionMode>(self, accel: &A, ray: &Ray) -> Hit {
        if !ray.is_valid() {
            return Hit::MISS;
        }
        accel.query::<Closest, P>(ray).map_or(Hit::MISS, complete)
    }
}

impl Question for Occlusion {
    type Answer = bool;

    #[inline(always)]
    fn answer<A: Accel, P: PrecisionMode>(self, accel: &A, ray: &Ray) -> bool {
        ray.is_valid() && accel.query::<AnyHit, P>(ray).is_some()
    }
}

fn complete(found: ClosestHit) -> Hit {
    Hit {
        t: found.t,
        u: found.u,
        v: found.v,
        normal: found.triangle.normal(),
        primitive_id: found.triangle.primitive_id,
        geometry_id: found.triangle.geometry_id,
        instance_id: INVALID_ID,
    }
}

struct Single<'a, Q>(Q, &'a Ray);

impl<Q: Question> Kernel for Single<'_, Q> {
    type Output = Q::Answer;

    #[inline(always)]
    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) -> Q::Answer {
        self.0.answer::<A, P>(accel, self.1)
    }
}
