//! What every builder needs beside its triangles: threads, a limit on memory, and somebody who watches.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::ThreadPool;
use rayon::prelude::*;

use super::copies::Copied;
use crate::memory::prefer_huge_pages;
use crate::simd::{DetectedIsa, Isa, Simd, SimdKernel};

/// Why a build ended without a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BuildFailure {
    Cancelled,
    /// The build would have held more than the caller allows.
    OverLimit {
        needed: usize,
        limit: usize,
    },
    /// More than the structure's references can tell apart.
    TooManyTriangles {
        count: usize,
        limit: usize,
    },
    /// The allocator refused.
    OutOfMemory {
        bytes: usize,
    },
}

/// What the caller's thread and the build share.
#[derive(Default)]
pub(crate) struct Watch {
    cancelled: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
}

impl Watch {
    pub(crate) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// In `[0, 1]`.
    pub(crate) fn done(&self) -> f64 {
        let total = self.total.load(Ordering::Relaxed);
        if total == 0 { 0.0 } else { (self.done.load(Ordering::Relaxed) as f64 / total as f64).min(1.0) }
    }
}

/// How many elements a chunk has: so many that starting a task for it does not show.
pub(crate) const CHUNK: usize = 1 << 14;

/// Threads, memory and progress of one build.
pub(crate) struct BuildContext<'a> {
    /// None: the caller's thread alone.
    pool: Option<&'a ThreadPool>,
    limit: Option<usize>,
    held: AtomicUsize,
    peak: AtomicUsize,
    watch: &'a Watch,
    isa: DetectedIsa,
    copies: Mutex<Result<Vec<Copied>, BuildFailure>>,
}

impl<'a> BuildContext<'a> {
    pub(crate) fn new(pool: Option<&'a ThreadPool>, limit: Option<usize>, isa: Isa, watch: &'a Watch) -> Self {
        Self {
            pool,
            limit,
            held: AtomicUsize::new(0),
            peak: AtomicUsize::new(0),
            watch,
            isa: isa.resolve(),
            copies: Mutex::new(Ok(Vec::new())),
        }
    }

    /// Runs a kernel on the build's instruction set. Builders use no operation that differs between them, so that they
    /// all build the same.
    pub(crate) fn vectorize<K: SimdKernel>(&self, kernel: K) -> K::Output {
        match self.isa {
            DetectedIsa::Scalar(simd) => simd.vectorize_build(kernel),
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Sse42(simd) => simd.vectorize_build(kernel),
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Avx2(simd) => simd.vectorize_build(kernel),
            #[cfg(target_arch = "x86_64")]
            DetectedIsa::Avx512(simd) => simd.vectorize_build(kernel),
        }
    }

    /// Announces units of work that [`BuildContext::advance`] will count.
    pub(crate) fn expect(&self, work: usize) {
        self.watch.total.fetch_add(work, Ordering::Relaxed);
    }

    /// Counts work that is done; fails once somebody cancelled.
    pub(crate) fn advance(&self, work: usize) -> Result<(), BuildFailure> {
        self.watch.done.fetch_add(work, Ordering::Relaxed);
        self.check()
    }

    pub(crate) fn check(&self) -> Result<(), BuildFailure> {
        if self.watch.cancelled.load(Ordering::Relaxed) { Err(BuildFailure::Cancelled) } else { Ok(()) }
    }

    /// An empty vector with room for exactly `count`, counted against the limit before it is allocated.
    pub(crate) fn reserve<T>(&self, count: usize) -> Result<Vec<T>, BuildFailure> {
        let bytes = count.checked_mul(size_of::<T>()).ok_or(BuildFailure::OutOfMemory { bytes: usize::MAX })?;
        let held = self.held.fetch_add(bytes, Ordering::Relaxed) + bytes;
        if let Some(limit) = self.limit
            && held > limit
        {
            return Err(BuildFailure::OverLimit { needed: held, limit });
        }
        let mut vector = Vec::new();
        vector.try_reserve_exact(count).map_err(|_| BuildFailure::OutOfMemory { bytes })?;
        prefer_huge_pages(vector.spare_capacity_mut());
        self.peak.fetch_max(held, Ordering::Relaxed);
        Ok(vector)
    }

    /// Room for `additional` elements more, in a vector whose length nobody knows beforehand.
    pub(crate) fn make_room<T>(&self, vector: &mut Vec<T>, additional: usize) -> Result<(), BuildFailure> {
        let needed = vector.len() + additional;
        if needed > vector.capacity() {
            let mut larger = self.reserve(needed.max(2 * vector.capacity()))?;
            larger.append(vector);
            self.release(std::mem::replace(vector, larger));
        }
        Ok(())
    }

    /// As [`BuildContext::reserve`], filled with copies of `value` by all threads, so that they share the page faults.
    pub(crate) fn filled<T: Copy + Send + Sync>(&self, count: usize, value: T) -> Result<Vec<T>, BuildFailure> {
        let mut vector = self.reserve(count)?;
        if self.is_parallel() {
            vector.par_extend(rayon::iter::repeat_n(value, count));
        } else {
            vector.resize(count, value);
        }
        Ok(vector)
    }

    /// As [`BuildContext::filled`], by this thread alone.
    pub(crate) fn filled_here<T: Copy>(&self, count: usize, value: T) -> Result<Vec<T>, BuildFailure> {
        let mut vector = self.reserve(count)?;
        vector.resize(count, value);
        Ok(vector)
    }

    /// Appends `make(state, i)` for each `i` below `count`, on all threads; `start(i)` makes the state of a run of
    /// numbers from `i` on.
    pub(crate) fn collect_with<T: Send, A>(
        &self,
        vector: &mut Vec<T>,
        count: u32,
        start: impl Fn(u32) -> A + Sync,
        make: impl Fn(&mut A, u32) -> T + Sync,
    ) {
        let next = |state: &mut Option<A>, number| make(state.get_or_insert_with(|| start(number)), number);
        if self.is_parallel() {
            vector.par_extend((0..count).into_par_iter().map_init(|| None, next));
        } else {
            let mut state = None;
            vector.extend((0..count).map(|number| next(&mut state, number)));
        }
    }

    /// Maps chunks of a slice and combines in their order what they give; `None` of an empty slice. The chunks are the
    /// same for any number of threads.
    pub(crate) fn reduce_chunks<T: Sync, A: Send>(
        &self,
        values: &[T],
        map: impl Fn(&[T]) -> A + Sync + Send,
        combine: impl Fn(A, A) -> A + Sync + Send,
    ) -> Option<A> {
        if self.is_parallel() && values.len() > CHUNK {
            values.par_chunks(CHUNK).map(map).reduce_with(combine)
        } else {
            values.chunks(CHUNK).map(map).reduce(combine)
        }
    }

    /// As [`BuildContext::reduce_chunks`], but the chunks may be written to, and what they give is kept.
    pub(crate) fn map_chunks<T: Send, A: Send>(
        &self,
        values: &mut [T],
        map: impl Fn(&mut [T]) -> A + Sync + Send,
    ) -> Vec<A> {
        if self.is_parallel() && values.len() > CHUNK {
            values.par_chunks_mut(CHUNK).map(map).collect()
        } else {
            values.chunks_mut(CHUNK).map(map).collect()
        }
    }

    /// Maps each value, on all threads.
    pub(crate) fn map_each<T: Send, A: Send>(&self, values: Vec<T>, map: impl Fn(T) -> A + Sync + Send) -> Vec<A> {
        if self.is_parallel() {
            values.into_par_iter().map(map).collect()
        } else {
            values.into_iter().map(map).collect()
        }
    }

    /// Frees what a vector does not need.
    pub(crate) fn shrink<T>(&self, vector: &mut Vec<T>) {
        let before = vector.capacity();
        vector.shrink_to_fit();
        self.held.fetch_sub((before - vector.capacity()) * size_of::<T>(), Ordering::Relaxed);
    }

    /// Frees what [`BuildContext::reserve`] gave.
    pub(crate) fn release<T>(&self, vector: Vec<T>) {
        self.held.fetch_sub(vector.capacity() * size_of::<T>(), Ordering::Relaxed);
    }

    /// Notes that a primitive is not stored, at least in one place, because another one is the same to the bit. A failure
    /// shows when they are taken.
    pub(crate) fn note_copy(&self, copy: Copied) {
        let mut noted = self.copies.lock().expect("noting does not panic");
        if let Ok(copies) = &mut *noted
            && let Err(failure) = self.append_copy(copies, copy)
        {
            *noted = Err(failure);
        }
    }

    fn append_copy(&self, copies: &mut Vec<Copied>, copy: Copied) -> Result<(), BuildFailure> {
        if copies.len() == copies.capacity() {
            // One may be noted in many places.
            copies.sort_unstable();
            copies.dedup();
            if 2 * copies.len() >= copies.capacity() {
                self.make_room(copies, 1)?;
            }
        }
        copies.push(copy);
        Ok(())
    }

    /// All that were noted.
    pub(crate) fn take_copies(&self) -> Result<Vec<Copied>, BuildFailure> {
        std::mem::replace(&mut *self.copies.lock().expect("noting does not panic"), Ok(Vec::new()))
    }

    pub(crate) fn peak_bytes(&self) -> usize {
        self.peak.load(Ordering::Relaxed)
    }

    /// Runs a whole build where [`BuildContext::join`] finds the threads.
    pub(crate) fn install<T: Send>(&self, build: impl FnOnce() -> T + Send) -> T {
        match self.pool {
            Some(pool) => pool.install(build),
            None => build(),
        }
    }

    pub(crate) fn is_parallel(&self) -> bool {
        self.pool.is_some()
    }

    /// Both, at the same time where there are threads.
    pub(crate) fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if self.is_parallel() { rayon::join(first, second) } else { (first(), second()) }
    }
}

/// The parts of these lengths, in their order.
pub(super) fn slices<'a, T>(mut values: &'a mut [T], lengths: &[usize]) -> Vec<&'a mut [T]> {
    lengths
        .iter()
        .map(|&length| {
            let (part, rest) = std::mem::take(&mut values).split_at_mut(length);
            values = rest;
            part
        })
        .collect()
}
