//! Which gnomon this is.

use std::ffi::{CStr, c_char};

const fn number(text: &str) -> u32 {
    let (bytes, mut value, mut at) = (text.as_bytes(), 0, 0);
    while at < bytes.len() {
        value = 10 * value + (bytes[at] - b'0') as u32;
        at += 1;
    }
    value
}

/// The version of the library that answers, as `major * 10000 + minor * 100 + patch`.
///
/// Until version 1 a minor version may change the interface. Any thread may call this.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_version() -> u32 {
    const MAJOR: u32 = number(env!("CARGO_PKG_VERSION_MAJOR"));
    const MINOR: u32 = number(env!("CARGO_PKG_VERSION_MINOR"));
    const PATCH: u32 = number(env!("CARGO_PKG_VERSION_PATCH"));
    MAJOR * 10_000 + MINOR * 100 + PATCH
}

/// The same as text, for example "0.1.0". Static. Any thread may call this.
#[unsafe(no_mangle)]
pub extern "C-unwind" fn gnomon_version_string() -> *const c_char {
    const TEXT: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(text) => text,
        Err(_) => panic!("a version holds no NUL"),
    };
    TEXT.as_ptr()
}
