//! What every builder needs beside its triangles: threads, a limit on memory, and somebody who watches.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::ThreadPool;
use rayon::prelude::*;

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

/// Threads, memory and progress of one build.
pub(crate) struct BuildContext<'a> {
    /// None: the caller's thread alone.
    pool: Option<&'a ThreadPool>,
    limit: Option<usize>,
    held: AtomicUsize,
    peak: AtomicUsize,
    watch: &'a Watch,
}

impl<'a> BuildContext<'a> {
    pub(crate) fn new(pool: Option<&'a ThreadPool>, limit: Option<usize>, watch: &'a Watch) -> Self {
        Self { pool, limit, held: AtomicUsize::new(0), peak: AtomicUsize::new(0), watch }
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
        self.peak.fetch_max(held, Ordering::Relaxed);
        Ok(vector)
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

    /// Frees what [`BuildContext::reserve`] gave.
    pub(crate) fn release<T>(&self, vector: Vec<T>) {
        self.held.fetch_sub(vector.capacity() * size_of::<T>(), Ordering::Relaxed);
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
