//! A worker's share of a batch: rays that go the same way as packets, the others in flight or one by one, whichever is
//! faster.

use std::marker::PhantomData;
use std::time::Instant;

use super::WideBvh;
use super::coherent::{Coherent, LEAST_PACKET, PACKET};
use super::packet::Packet;
use super::wavefront::{self, Flight};
use crate::accel::leaf::{ClosestHit, Query};
use crate::geometry::{Aabb, PrecisionMode, Ray};
use crate::simd::{Simd, SimdKernel};

/// Trees smaller than this are in the nearest caches: no ray waits long, so neighbours in flight gain nothing. Tests have only such.
const LEAST_BYTES: usize = if cfg!(debug_assertions) { 1 } else { 2 << 20 };

/// The fewest rays of a run for which the wavefront's memory is asked for.
const LEAST_RAYS: usize = 2 * wavefront::IN_FLIGHT;

/// The most rays that pass by after some that went different ways before some are looked at as a packet again, and that
/// show at first how long they take. A single refusal costs no more than its rays: a row of an image has one where the camera looks
/// along an axis.
const LOOK_AGAIN: usize = 64;
/// The most rays that pass by after packets that did not pay.
const MOST_PATIENCE: usize = 64 * LOOK_AGAIN;

/// How many rays a way is tried with: enough that the last ones in flight, which have ever fewer neighbours, do not show.
const TRIAL: usize = 512;
/// The most rays before the slower way is tried again.
const LONGEST_STRETCH: usize = 64 * TRIAL;

/// How rays go that no packet answers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    InFlight,
    Alone,
}

/// The faster way, and the stretch of rays that goes one way now. After each stretch of the faster way the other is tried,
/// ever more seldom while it stays the slower one.
struct Choice {
    faster: Way,
    /// In seconds a ray, of its last stretch.
    faster_pace: f64,
    way: Way,
    /// How many rays the next stretch of the faster way takes.
    patience: usize,
}

impl Choice {
    fn new() -> Self {
        Self { faster: Way::InFlight, faster_pace: 0.0, way: Way::InFlight, patience: TRIAL }
    }

    fn stretch(&self) -> usize {
        if self.way == self.faster { self.patience } else { TRIAL }
    }

    /// After a stretch at this pace.
    fn go_on(&mut self, pace: f64) {
        if self.way == self.faster {
            self.faster_pace = pace;
            self.way = if self.way == Way::InFlight { Way::Alone } else { Way::InFlight };
        } else if pace < self.faster_pace {
            (self.faster, self.faster_pace, self.patience) = (self.way, pace, TRIAL);
        } else {
            self.way = self.faster;
            self.patience = (4 * self.patience).min(LONGEST_STRETCH);
        }
    }
}

/// How long rays take that no packet answers, in this stretch; while that has few, in the one before.
struct Pace {
    since: Instant,
    /// Whether there was any work since then.
    is_running: bool,
    seconds: f64,
    /// How many were answered: what is in flight has its work before it.
    rays: usize,
    seconds_per_ray: f64,
}

impl Pace {
    fn new() -> Self {
        Self { since: Instant::now(), is_running: false, seconds: 0.0, rays: 0, seconds_per_ray: f64::INFINITY }
    }

    /// Before a packet.
    fn pause(&mut self) {
        if self.is_running {
            self.is_running = false;
            self.look();
        }
    }

    fn look(&mut self) {
        let now = Instant::now();
        self.seconds += (now - self.since).as_secs_f64();
        self.since = now;
        if self.rays >= LOOK_AGAIN / 2 {
            self.seconds_per_ray = self.seconds / self.rays as f64;
        }
    }

    /// Of the whole stretch, if packets left any of it; another begins.
    fn end_stretch(&mut self) -> Option<f64> {
        self.look();
        let pace = (self.rays != 0).then(|| self.seconds / self.rays as f64);
        (self.is_running, self.seconds, self.rays) = (false, 0.0, 0);
        pace
    }
}

/// Where rays come from: runs of rays with a place for each answer.
pub(super) struct Source<'a, R, T, N, W> {
    /// Of packets, and of rays that go alone.
    simd: W,
    rays: &'a [R],
    answers: &'a mut [T],
    next_run: N,
    /// Whether there is no further run.
    is_at_end: bool,
    /// How many rays this stretch still takes.
    left: usize,
    /// How many rays are left of those that are not looked at as packets.
    refused: usize,
    /// How many rays to pass by after the next packet that does not pay.
    patience: usize,
    /// Whether the refused rays go the same way all the same: such are faster one by one than in flight.
    are_coherent: bool,
    others: Pace,
}

impl<'a, R, T, N, W: Simd> Source<'a, R, T, N, W>
where
    for<'r> &'r R: Into<Ray>,
    N: FnMut() -> Option<(&'a [R], &'a mut [T])>,
{
    /// The first rays show how long they take without packets.
    fn new(simd: W, next_run: N) -> Self {
        Self {
            simd,
            rays: &[],
            answers: &mut [],
            next_run,
            is_at_end: false,
            left: 0,
            refused: LOOK_AGAIN,
            patience: PACKET,
            are_coherent: false,
            others: Pace::new(),
        }
    }

    pub(super) fn are_coherent(&self) -> bool {
        self.are_coherent
    }

    /// Goes on to the next run, if this one has no rays left; false if there is none.
    #[inline(always)]
    fn has_rays(&mut self) -> bool {
        while self.rays.is_empty() && !self.is_at_end {
            match (self.next_run)() {
                // Without a place a ray has no answer.
                Some((rays, answers)) => (self.rays, self.answers) = (&rays[..rays.len().min(answers.len())], answers),
                None => self.is_at_end = true,
            }
        }
        !self.is_at_end
    }

    /// The next ray of this stretch that no packet has answered.
    #[inline(always)]
    pub(super) fn next(&mut self) -> Option<(&'a R, &'a mut T)> {
        if self.left == 0 || !self.has_rays() {
            return None;
        }
        let (ray, rays) = self.rays.split_first()?;
        let (answer, answers) = std::mem::take(&mut self.answers).split_first_mut()?;
        (self.rays, self.answers) = (rays, answers);
        self.left -= 1;
        self.refused = self.refused.saturating_sub(1);
        self.others.is_running = true;
        Some((ray, answer))
    }

    /// A ray by itself.
    #[inline(always)]
    pub(super) fn answer_alone<Q: Query, P: PrecisionMode>(
        &mut self,
        bvh: &WideBvh,
        ray: Ray,
        place: &mut T,
        answer: &impl Fn(&mut T, Option<ClosestHit>),
    ) {
        answer(place, bvh.find::<Q, P, W>(self.simd, ray).0);
        self.count_answered();
    }

    /// Another ray is answered that no packet took.
    #[inline(always)]
    pub(super) fn count_answered(&mut self) {
        self.others.rays += 1;
    }

    /// Whether the next rays make a packet. After some that do not, others pass by first. Looks before at how long rays take without.
    #[inline(always)]
    fn take_packet(&mut self, simd: impl Simd, bounds: &Aabb, coherent: &mut Coherent) -> bool {
        if self.refused != 0 || !self.has_rays() {
            return false;
        }
        if self.rays.len() < LEAST_PACKET {
            // The end of a run tells nothing of the next one.
            (self.refused, self.are_coherent) = (self.rays.len(), false);
            return false;
        }
        self.others.pause();
        self.are_coherent = coherent.take(simd, self.rays, bounds);
        if !self.are_coherent {
            self.refused = self.patience.min(LOOK_AGAIN);
            self.patience = self.patience.max(2 * self.refused);
        }
        self.are_coherent
    }

    /// After a packet of so many. If it took longer than its rays would have alone, ever more of those that follow are left to the
    /// others.
    #[inline(always)]
    fn end_packet(&mut self, count: usize) {
        let start = std::mem::replace(&mut self.others.since, Instant::now());
        self.rays = &self.rays[count..];
        self.answers = &mut std::mem::take(&mut self.answers)[count..];
        let seconds_per_ray = (self.others.since - start).as_secs_f64() / count as f64;
        if seconds_per_ray < self.others.seconds_per_ray {
            self.patience = PACKET;
        } else {
            self.refused = self.patience;
            self.patience = (2 * self.patience).min(MOST_PATIENCE);
        }
    }

    /// Answers the next rays in packets, as long as those pay.
    #[inline(always)]
    pub(super) fn answer_packets<Q: Query, P: PrecisionMode>(
        &mut self,
        bvh: &WideBvh,
        answer: &impl Fn(&mut T, Option<ClosestHit>),
    ) {
        if self.refused == 0 {
            self.simd.vectorize_batch(Packets::<Q, P, _, _, _, _, _> {
                bvh,
                source: self,
                answer,
                choices: PhantomData,
            });
        }
    }
}

/// Packets as long as they pay, as a kernel.
struct Packets<'b, 's, 'a, Q, P, R, T, N, W, A> {
    bvh: &'b WideBvh,
    source: &'s mut Source<'a, R, T, N, W>,
    answer: &'s A,
    choices: PhantomData<(Q, P)>,
}

impl<'a, Q, P, R, T, N, W: Simd, A> SimdKernel for Packets<'_, '_, 'a, Q, P, R, T, N, W, A>
where
    for<'r> &'r R: Into<Ray>,
    N: FnMut() -> Option<(&'a [R], &'a mut [T])>,
    A: Fn(&mut T, Option<ClosestHit>),
    Q: Query,
    P: PrecisionMode,
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { bvh, source, answer, .. } = self;
        let mut coherent = Coherent::NONE;
        while source.take_packet(simd, &bvh.bounds, &mut coherent) {
            let count = coherent.count;
            let (rays, places) = (&source.rays[..count], &mut source.answers[..count]);
            Packet::<Q, P, _, _, _>::new(bvh, rays, &coherent, places, answer).run(simd);
            source.end_packet(count);
        }
    }
}

/// The rays of one worker, as a kernel.
pub(super) struct Batch<'b, 'a, Q, P, R, T, N, W, A> {
    bvh: &'b WideBvh,
    source: Source<'a, R, T, N, W>,
    answer: A,
    choices: PhantomData<(Q, P)>,
}

impl<'b, 'a, Q, P, R, T, N, W: Simd, A> Batch<'b, 'a, Q, P, R, T, N, W, A>
where
    for<'r> &'r R: Into<Ray>,
    N: FnMut() -> Option<(&'a [R], &'a mut [T])>,
{
    /// `simd` is for all but rays in flight.
    pub(super) fn new(simd: W, bvh: &'b WideBvh, next_run: N, answer: A) -> Self {
        Self { bvh, source: Source::new(simd, next_run), answer, choices: PhantomData }
    }
}

impl<'a, Q, P, R, T, N, W: Simd, A> SimdKernel for Batch<'_, 'a, Q, P, R, T, N, W, A>
where
    for<'r> &'r R: Into<Ray>,
    N: FnMut() -> Option<(&'a [R], &'a mut [T])>,
    A: Fn(&mut T, Option<ClosestHit>),
    Q: Query,
    P: PrecisionMode,
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { bvh, mut source, answer, .. } = self;
        let has_packets = wavefront::is_in_range(bvh);
        let may_fly = has_packets && bvh.bytes() >= LEAST_BYTES && wavefront::is_shallow(bvh);
        let mut memory = Vec::new();
        let mut choice = Choice::new();
        while source.has_rays() {
            // Not where a tree or a run is too small to pay for it, or where there is no memory.
            let flies = may_fly
                && source.rays.len() >= LEAST_RAYS
                && (!memory.is_empty() || memory.try_reserve_exact(wavefront::IN_FLIGHT).is_ok());
            source.left = match (flies, may_fly) {
                (true, _) => choice.stretch(),
                (false, true) => source.rays.len(),
                (false, false) => usize::MAX,
            };
            if flies && choice.way == Way::InFlight {
                Flight::new(bvh, &mut source, &answer, wavefront::stacks(&mut memory)).run::<Q, P, S>(simd);
            } else {
                answer_alone::<Q, P, _, _, _, _>(bvh, &mut source, has_packets, &answer);
            }
            let pace = source.others.end_stretch();
            if flies && let Some(pace) = pace {
                choice.go_on(pace);
            }
        }
    }
}

/// The rays of a stretch one by one, but for packets.
#[inline(always)]
fn answer_alone<'a, Q: Query, P: PrecisionMode, R, T, N, W: Simd>(
    bvh: &WideBvh,
    source: &mut Source<'a, R, T, N, W>,
    has_packets: bool,
    answer: &impl Fn(&mut T, Option<ClosestHit>),
) where
    for<'r> &'r R: Into<Ray>,
    N: FnMut() -> Option<(&'a [R], &'a mut [T])>,
{
    loop {
        if has_packets {
            source.answer_packets::<Q, P>(bvh, answer);
        }
        let Some((ray, place)) = source.next() else { return };
        source.answer_alone::<Q, P>(bvh, ray.into(), place, answer);
    }
}
