//! Status numbers, the calling thread's last error, and the wall that no panic passes.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::accel::OutOfMemory;
use crate::scene::{BuildError, SurfaceError};

/// How a call ended: one of the `GNOMON_OK` and `GNOMON_ERROR_*` numbers. They never change their meaning; a later
/// version may add some.
pub type GnomonStatus = u32;

/// All went well.
pub const GNOMON_OK: u32 = 0;
/// An argument can't be used: a null pointer, an unknown number, an index out of range, a coordinate that is not
/// finite. The caller can mend it.
pub const GNOMON_ERROR_INVALID_ARGUMENT: u32 = 1;
/// Memory ran out, or `memory_limit_bytes` would have been passed. Nothing was changed.
pub const GNOMON_ERROR_OUT_OF_MEMORY: u32 = 2;
/// The progress callback asked for an end.
pub const GNOMON_ERROR_CANCELLED: u32 = 3;
/// This version has no such structure, quality or precision. None is missing at present.
pub const GNOMON_ERROR_UNSUPPORTED: u32 = 4;
/// A bug in gnomon, or a machine that could not start threads. Nothing was changed.
pub const GNOMON_ERROR_INTERNAL: u32 = 5;

/// A status with the sentence for [`gnomon_last_error`].
#[derive(Debug)]
pub(super) struct Failure {
    status: GnomonStatus,
    message: String,
}

impl Failure {
    pub(super) fn invalid(message: impl Into<String>) -> Self {
        Self { status: GNOMON_ERROR_INVALID_ARGUMENT, message: message.into() }
    }

    pub(super) fn out_of_memory(message: impl Into<String>) -> Self {
        Self { status: GNOMON_ERROR_OUT_OF_MEMORY, message: message.into() }
    }

    /// With what it happened in before the message.
    pub(super) fn within(self, what: &str) -> Self {
        Self { message: format!("{what}: {}", self.message), ..self }
    }
}

impl From<BuildError> for Failure {
    fn from(error: BuildError) -> Self {
        let status = match error {
            BuildError::IndexOutOfRange { .. }
            | BuildError::TooFewVertices { .. }
            | BuildError::TooMany { .. }
            | BuildError::TooManyInScene { .. }
            | BuildError::NotFinite { .. }
            | BuildError::InvalidSphere { .. } => GNOMON_ERROR_INVALID_ARGUMENT,
            BuildError::Cancelled => GNOMON_ERROR_CANCELLED,
            BuildError::OverMemoryLimit { .. } | BuildError::OutOfMemory { .. } => GNOMON_ERROR_OUT_OF_MEMORY,
            BuildError::Threads(_) | BuildError::Internal(_) => GNOMON_ERROR_INTERNAL,
        };
        Self { status, message: error.to_string() }
    }
}

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Self {
        let status = match error {
            SurfaceError::OutOfMemory(_) => GNOMON_ERROR_OUT_OF_MEMORY,
            SurfaceError::Miss
            | SurfaceError::InvalidRay
            | SurfaceError::NotInScene { .. }
            | SurfaceError::Passed { .. }
            | SurfaceError::NoDirection { .. }
            | SurfaceError::NoOrigin => GNOMON_ERROR_INVALID_ARGUMENT,
        };
        Self { status, message: error.to_string() }
    }
}

impl From<OutOfMemory> for Failure {
    fn from(error: OutOfMemory) -> Self {
        Self { status: GNOMON_ERROR_OUT_OF_MEMORY, message: error.to_string() }
    }
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Keeps the sentence for the calling thread and returns the status.
pub(super) fn report(failure: Failure) -> GnomonStatus {
    // A message may quote what a caller passed, but no such value prints as a NUL.
    let message = CString::new(failure.message).unwrap_or_default();
    // A thread that is ending has no such storage any more: then the status alone must do.
    let _ = LAST_ERROR.try_with(|last| *last.borrow_mut() = message);
    failure.status
}

/// Runs a call's body; neither an error nor a panic gets out other than as a status.
pub(super) fn guard(body: impl FnOnce() -> Result<(), Failure>) -> GnomonStatus {
    match caught(body) {
        Ok(()) => GNOMON_OK,
        Err(failure) => report(failure),
    }
}

/// Runs the body of a call that gives a number: a NaN where there is none.
pub(super) fn number_or_nan(body: impl FnOnce() -> Result<f64, Failure>) -> f64 {
    caught(body).unwrap_or_else(|failure| {
        report(failure);
        f64::NAN
    })
}

/// As [`guard`], for a body that gives something.
pub(super) fn caught<T>(body: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    // What a body changes before it panics is its own local state: outputs are written last.
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| Err(panicked(&*panic)))
}

pub(super) fn panicked(panic: &(dyn Any + Send)) -> Failure {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("without a message");
    Failure { status: GNOMON_ERROR_INTERNAL, message: format!("a bug in gnomon: {message}") }
}

/// The last failure of the calling thread as one sentence that names the culprit and its values: which geometry,
/// which triangle, which index. "" before the first one; a later success does not clear it.
///
/// The text is UTF-8 and ends with a NUL; it belongs to the library and stays valid until the next failing call on
/// the same thread, or the thread's end. Any thread may call this.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_last_error() -> *const c_char {
    LAST_ERROR.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// The name of a status, for example "GNOMON_ERROR_OUT_OF_MEMORY"; "GNOMON_STATUS_UNKNOWN" for a number without a
/// meaning.
///
/// The text is static. Any thread may call this.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_status_name(status: u32) -> *const c_char {
    let name = match status {
        GNOMON_OK => c"GNOMON_OK",
        GNOMON_ERROR_INVALID_ARGUMENT => c"GNOMON_ERROR_INVALID_ARGUMENT",
        GNOMON_ERROR_OUT_OF_MEMORY => c"GNOMON_ERROR_OUT_OF_MEMORY",
        GNOMON_ERROR_CANCELLED => c"GNOMON_ERROR_CANCELLED",
        GNOMON_ERROR_UNSUPPORTED => c"GNOMON_ERROR_UNSUPPORTED",
        GNOMON_ERROR_INTERNAL => c"GNOMON_ERROR_INTERNAL",
        _ => c"GNOMON_STATUS_UNKNOWN",
    };
    name.as_ptr()
}
