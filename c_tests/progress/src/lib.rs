//! indicatif's progress bar behind four C functions: drawn on standard error while that is a terminal, silent otherwise.

use std::ffi::{CStr, c_char};

use indicatif::{ProgressBar, ProgressStyle};

const TEMPLATE: &str = "{bar:32} {percent:>3} %  {elapsed} (left: {eta})  {msg}";

/// A bar over `total` steps; give it back to `progress_finish`. `label` is UTF-8 and copied.
///
/// # Safety
/// `label` is a string that ends in NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn progress_new(total: u64, label: *const c_char) -> *mut ProgressBar {
    let bar = ProgressBar::new(total);
    bar.set_style(ProgressStyle::with_template(TEMPLATE).expect("the template is a constant"));
    // SAFETY: the caller's duty above.
    bar.set_message(unsafe { text(label) });
    Box::into_raw(Box::new(bar))
}

/// Says what is being done now.
///
/// # Safety
/// `bar` comes from `progress_new` and is not finished; `label` is a string that ends in NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn progress_set_label(bar: *const ProgressBar, label: *const c_char) {
    // SAFETY: the caller's duty above.
    let (bar, label) = unsafe { (&*bar, text(label)) };
    bar.set_message(label);
}

/// Counts `steps` more as done; from any thread.
///
/// # Safety
/// `bar` comes from `progress_new` and is not finished.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn progress_advance(bar: *const ProgressBar, steps: u64) {
    // SAFETY: the caller's duty above.
    let bar = unsafe { &*bar };
    bar.inc(steps);
}

/// Takes the bar off the screen and frees it.
///
/// # Safety
/// `bar` comes from `progress_new` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn progress_finish(bar: *mut ProgressBar) {
    // SAFETY: the caller's duty above.
    let bar = unsafe { Box::from_raw(bar) };
    bar.finish_and_clear();
}

/// # Safety
/// `label` is a string that ends in NUL.
unsafe fn text(label: *const c_char) -> String {
    // SAFETY: the caller's duty above.
    unsafe { CStr::from_ptr(label) }.to_string_lossy().into_owned()
}
