//! What the operating system should know of large allocations.
#![expect(unsafe_code, reason = "a system call")]

use std::mem::MaybeUninit;

/// Below this few pages would be large.
#[cfg(target_os = "linux")]
const LEAST_BYTES: usize = 4 << 20;
/// A multiple of every small page's size.
#[cfg(target_os = "linux")]
const PAGE: usize = 1 << 16;

/// Asks for large pages behind memory that is not written yet. Random rays among 871 thousand triangles then are a tenth
/// faster, bounce and shadow rays 4 %, because far fewer addresses have to be translated. Small pages do as well: nothing
/// depends on the answer.
#[cfg_attr(not(target_os = "linux"), expect(unused_variables, reason = "no such call"))]
pub(crate) fn prefer_huge_pages<T>(memory: &mut [MaybeUninit<T>]) {
    #[cfg(target_os = "linux")]
    if size_of_val(memory) >= LEAST_BYTES {
        let range = memory.as_mut_ptr_range();
        let start = range.start.addr().next_multiple_of(PAGE);
        let length = (range.end.addr() - start) & !(PAGE - 1);
        // SAFETY: the pages belong to an allocation that is borrowed mutably, and the advice does not change what they
        // hold.
        unsafe { libc::madvise(range.start.with_addr(start).cast(), length, libc::MADV_HUGEPAGE) };
    }
}
