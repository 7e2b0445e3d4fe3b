//! Many rays in one call, shared out among threads in runs of neighbours.

use std::mem::MaybeUninit;
use std::sync::Mutex;

use super::query::{ClosestOf, Kernel, Occlusion, Question};
use super::{Scene, threads};
use crate::accel::Accel;
use crate::geometry::{Hit, PrecisionMode, Ray};

impl Scene {
    /// As [`Scene::intersect`] for each ray, on at most `thread_count` threads: 0 for all, 1 for the calling one alone.
    /// `hits` has one place a ray; what it held is overwritten.
    pub fn intersect_n(&self, rays: &[Ray], hits: &mut [MaybeUninit<Hit>], thread_count: u32) {
        self.dispatch(Batch { question: ClosestOf, rays, answers: hits, thread_count });
    }

    /// As [`Scene::occluded`] for each ray; see [`Scene::intersect_n`].
    pub fn occluded_n(&self, rays: &[Ray], occluded: &mut [MaybeUninit<bool>], thread_count: u32) {
        self.dispatch(Batch { question: Occlusion, rays, answers: occluded, thread_count });
    }
}

struct Batch<'a, Q, R, T> {
    question: Q,
    rays: &'a [R],
    answers: &'a mut [MaybeUninit<T>],
    thread_count: u32,
}

impl<Q, R, T> Kernel for Batch<'_, Q, R, T>
where
    Q: Question,
    R: Sync,
    for<'a> &'a R: Into<Ray>,
    T: From<Q::Answer> + Send,
{
    type Output = ();

    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) {
        /// Enough rays that taking the next run does not show, few enough that threads end together.
        const RUN: usize = 256;

        let run_count = self.rays.len().div_ceil(RUN);
        let answer = |place: &mut MaybeUninit<T>, found: Q::Answer| {
            place.write(found.into());
        };
        if self.thread_count == 1 || run_count <= 1 {
            let mut run = Some((self.rays, self.answers));
            return self.question.answer_runs::<A, P, R, _>(accel, || run.take(), answer);
        }
        let runs = Mutex::new(self.rays.chunks(RUN).zip(self.answers.chunks_mut(RUN)));
        let next_run = || runs.lock().expect("taking a run does not panic").next();
        threads::run_workers(self.thread_count, || {
            self.question.answer_runs::<A, P, R, _>(accel, next_run, answer);
        });
    }
}
