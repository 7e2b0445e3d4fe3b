//! The threads that builds and batches share: started once, at the first use.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::BuildError;

/// As many threads as the machine has; `None` where they could not be started, and work stays on the caller's thread.
pub(super) fn shared_pool() -> Option<&'static ThreadPool> {
    static POOL: OnceLock<Option<ThreadPool>> = OnceLock::new();
    POOL.get_or_init(|| new_pool(0).ok()).as_ref()
}

/// `thread_count` threads; 0: as many as the machine has.
pub(super) fn new_pool(thread_count: u32) -> Result<ThreadPool, BuildError> {
    ThreadPoolBuilder::new()
        .num_threads(thread_count as usize)
        .thread_name(|index| format!("gnomon-{index}"))
        .build()
        .map_err(|error| BuildError::Threads(error.to_string()))
}

/// Runs a worker on at most `thread_count` threads at a time, 0 for all; the calling one is always among them, so that not all have
/// to wake up.
pub(crate) fn run_workers(thread_count: u32, worker: impl Fn() + Sync) {
    let pool = if thread_count == 1 { None } else { shared_pool() };
    let Some(pool) = pool else { return worker() };
    let worker_count = match thread_count {
        0 => pool.current_num_threads(),
        count => pool.current_num_threads().min(count as usize),
    };
    pool.in_place_scope(|scope| {
        for _ in 1..worker_count {
            scope.spawn(|_| worker());
        }
        worker();
    });
}
