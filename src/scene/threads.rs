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
