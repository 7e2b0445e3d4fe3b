//! Queries: the one place where a scene's structure and precision are looked at, once a call.

use std::marker::PhantomData;

use super::both::Both;
use super::{Content, Scene};
use crate::accel::{
    Accel, AnyAccel, AnyHit, AnySurface, Closest, ClosestHit, Counted, LeafForm, Precision, Primitive, Query,
    RayCounts, Surface, WideBvh,
};
use crate::geometry::{Accurate, Exact, Fast, Hit, INVALID_ID, PrecisionMode, Ray, Sphere, Triangle};
use crate::simd::DetectedIsa;

/// Work that runs on whatever structure and precision a scene has.
pub(super) trait Kernel {
    type Output;
    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) -> Self::Output;
}

impl Scene {
    /// The closest hit of a ray, or [`Hit::MISS`].
    pub fn intersect(&self, ray: &Ray) -> Hit {
        self.find::<Closest>(ray).0.map_or(Hit::MISS, complete)
    }

    /// As [`Scene::intersect`], and what finding the hit took.
    pub fn intersect_counted(&self, ray: &Ray) -> (Hit, RayCounts) {
        let (found, counts) = self.find::<Counted>(ray);
        (found.map_or(Hit::MISS, complete), counts)
    }

    /// Whether the ray hits anything.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.find::<AnyHit>(ray).0.is_some()
    }

    /// As [`Scene::intersect`], the ray made and the hit used inside the kernel: a caller that writes it elsewhere saves a
    /// copy.
    #[inline]
    pub(crate) fn intersect_then<R>(&self, ray: impl Into<Ray>, then: impl FnOnce(Hit) -> R) -> R {
        self.dispatch(Single { question: ClosestOf, ray, then })
    }

    /// As [`Scene::occluded`], the ray made inside the kernel.
    #[inline]
    pub(crate) fn occluded_by(&self, ray: impl Into<Ray>) -> bool {
        self.dispatch(Single { question: Occlusion, ray, then: |is_hit| is_hit })
    }

    fn find<Q: Query>(&self, ray: &Ray) -> <Find<Q> as Kernel>::Output {
        self.dispatch(Find::<Q>::new(*ray))
    }

    #[inline(always)]
    pub(super) fn dispatch<K: Kernel>(&self, kernel: K) -> K::Output {
        match &self.content {
            Content::Triangles(triangles) => self.dispatch_to(kernel, triangles),
            Content::Spheres(spheres) => self.dispatch_to(kernel, spheres),
            Content::Both(both) => self.dispatch_to_both(kernel, &both.0, &both.1),
        }
    }

    #[inline(always)]
    pub(super) fn dispatch_to<K: Kernel, T: Primitive>(&self, kernel: K, accel: &AnyAccel<T>) -> K::Output {
        match accel {
            AnyAccel::WideBvh(bvh) => self.dispatch_isa(kernel, bvh),
            other => self.dispatch_to_other(kernel, other),
        }
    }

    /// Apart, so that the fastest structure's rays do not wait for a jump table.
    #[inline(never)]
    fn dispatch_to_other<K: Kernel, T: Primitive>(&self, kernel: K, accel: &AnyAccel<T>) -> K::Output {
        match accel {
            AnyAccel::BruteForce(brute_force) => self.dispatch_apart(kernel, brute_force),
            AnyAccel::Grid(grid) => self.dispatch_apart(kernel, grid),
            AnyAccel::Octree(octree) => self.dispatch_apart(kernel, octree),
            AnyAccel::KdTree(tree) => self.dispatch_apart(kernel, tree),
            AnyAccel::BspTree(tree) => self.dispatch_apart(kernel, tree),
            AnyAccel::Bvh(bvh) => self.dispatch_apart(kernel, bvh),
            // Comes the other way, but one match knows all structures.
            AnyAccel::WideBvh(bvh) => self.dispatch_isa(kernel, bvh),
            AnyAccel::CompactWideBvh(bvh) => self.dispatch_isa(kernel, bvh),
        }
    }

    #[inline(never)]
    fn dispatch_to_both<K: Kernel>(
        &self,
        kernel: K,
        triangles: &AnyAccel<Triangle>,
        spheres: &AnyAccel<Sphere>,
    ) -> K::Output {
        // Either part has its own precision.
        kernel.run::<_, Accurate>(&Both { scene: self, triangles, spheres })
    }

    #[inline(always)]
    fn dispatch_isa<K: Kernel, F: LeafForm>(&self, kernel: K, bvh: &WideBvh<F>) -> K::Output {
        match self.isa {
            DetectedIsa::Scalar(simd) => self.dispatch_precision(kernel, &bvh.on(simd)),
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Sse42(simd) => self.dispatch_precision(kernel, &bvh.on(simd)),
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Avx2(simd) => self.dispatch_precision(kernel, &bvh.on(simd)),
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Avx512(simd) => self.dispatch_precision(kernel, &bvh.on(simd)),
        }
    }

    /// In a frame of its own, as the vectorised kernels have it, so that no other kernel pays for its stack.
    #[inline(never)]
    fn dispatch_apart<K: Kernel, A: Accel + Sync>(&self, kernel: K, accel: &A) -> K::Output {
        self.dispatch_precision(kernel, accel)
    }

    #[inline(always)]
    fn dispatch_precision<K: Kernel, A: Accel + Sync>(&self, kernel: K, accel: &A) -> K::Output {
        match self.precision {
            Precision::Fast => kernel.run::<A, Fast>(accel),
            Precision::Accurate => kernel.run::<A, Accurate>(accel),
            Precision::Exact => kernel.run::<A, Exact>(accel),
        }
    }
}

/// A question about one ray.
pub(super) trait Question: Copy + Sync {
    type Answer: Send;
    fn answer<A: Accel, P: PrecisionMode, R>(
        self,
        accel: &A,
        ray: impl Into<Ray>,
        then: impl FnOnce(Self::Answer) -> R,
    ) -> R;

    /// See [`Accel::query_runs`].
    fn answer_runs<'r, A: Accel, P: PrecisionMode, R, T>(
        self,
        accel: &A,
        mut next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Self::Answer),
    ) where
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        while let Some((rays, places)) = next_run() {
            for (ray, place) in rays.iter().zip(places) {
                self.answer::<A, P, ()>(accel, ray, |found| answer(place, found));
            }
        }
    }
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
    fn answer<A: Accel, P: PrecisionMode, R>(self, accel: &A, ray: impl Into<Ray>, then: impl FnOnce(Hit) -> R) -> R {
        accel.query::<Closest, P, R>(ray, |found, ()| then(found.map_or(Hit::MISS, complete)))
    }

    #[inline(always)]
    fn answer_runs<'r, A: Accel, P: PrecisionMode, R, T>(
        self,
        accel: &A,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Hit),
    ) where
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        accel.query_runs::<Closest, P, R, T>(next_run, |place, found| answer(place, found.map_or(Hit::MISS, complete)));
    }
}

impl Question for Occlusion {
    type Answer = bool;

    #[inline(always)]
    fn answer<A: Accel, P: PrecisionMode, R>(self, accel: &A, ray: impl Into<Ray>, then: impl FnOnce(bool) -> R) -> R {
        accel.query::<AnyHit, P, R>(ray, |found, ()| then(found.is_some()))
    }

    #[inline(always)]
    fn answer_runs<'r, A: Accel, P: PrecisionMode, R, T>(
        self,
        accel: &A,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, bool),
    ) where
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        accel.query_runs::<AnyHit, P, R, T>(next_run, |place, found| answer(place, found.is_some()));
    }
}

#[inline(always)]
pub(super) fn complete(found: ClosestHit<impl Surface>) -> Hit {
    let (geometry_id, primitive_id) = found.primitive.ids();
    Hit {
        t: found.t,
        u: found.u,
        v: found.v,
        normal: found.primitive.normal(),
        primitive_id,
        geometry_id,
        instance_id: INVALID_ID,
    }
}

/// A question to whatever there is, with the kernels that all share who are not in a hurry.
pub(super) struct Find<Q> {
    ray: Ray,
    query: PhantomData<Q>,
}

impl<Q> Find<Q> {
    pub(super) fn new(ray: Ray) -> Self {
        Self { ray, query: PhantomData }
    }
}

impl<Q: Query> Kernel for Find<Q> {
    type Output = (Option<ClosestHit<AnySurface>>, Q::Tally);

    #[inline(always)]
    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) -> Self::Output {
        let (found, tally) = accel.find::<Q, P>(self.ray);
        (found.map(ClosestHit::on_any_surface), tally)
    }
}

struct Single<Q, I, T> {
    question: Q,
    ray: I,
    then: T,
}

impl<Q: Question, I: Into<Ray>, R, T: FnOnce(Q::Answer) -> R> Kernel for Single<Q, I, T> {
    type Output = R;

    #[inline(always)]
    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) -> R {
        self.question.answer::<A, P, R>(accel, self.ray, self.then)
    }
}
