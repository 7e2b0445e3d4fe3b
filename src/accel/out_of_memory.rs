//! What a query answers where the allocator refuses what it needs.

use thiserror::Error;

/// An allocation of a query failed.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("the allocation of {bytes} bytes failed")]
pub struct OutOfMemory {
    /// How much was asked for.
    pub bytes: usize,
}
