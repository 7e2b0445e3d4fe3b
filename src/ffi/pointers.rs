//! From raw pointers to references, once for each kind.

use std::mem::MaybeUninit;

use super::status::Failure;

/// The name of an argument that is null. Not a [`Failure`] yet: that would be made, and a query's registers saved for
/// it, in the midst of the checks.
pub(super) struct Null(&'static str);

impl From<Null> for Failure {
    #[cold]
    #[inline(never)]
    fn from(Null(name): Null) -> Self {
        Self::invalid(format!("{name} is null"))
    }
}

/// # Safety
/// `pointer` is null or points to a value that nothing writes while the reference lives.
pub(super) unsafe fn required<'a, T>(pointer: *const T, name: &'static str) -> Result<&'a T, Null> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_ref() }.ok_or(Null(name))
}

/// A place for an output, which may hold anything yet.
///
/// # Safety
/// `pointer` is null or points to memory for a `T` that nobody else uses while the reference lives.
pub(super) unsafe fn output<'a, T>(pointer: *mut T, name: &'static str) -> Result<&'a mut MaybeUninit<T>, Null> {
    // SAFETY: the caller's promise; MaybeUninit<T> has T's layout and no invariant.
    unsafe { pointer.cast::<MaybeUninit<T>>().as_mut() }.ok_or(Null(name))
}

/// `count` values; a null pointer is fine for none.
///
/// # Safety
/// `pointer` is null or points to `count` values that nothing writes while the slice lives.
pub(super) unsafe fn slice<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T], Failure> {
    check_extent::<T>(pointer.is_null(), count, name)?;
    if count == 0 {
        return Ok(&[]);
    }
    check_alignment(pointer, name)?;
    // SAFETY: not null, aligned, of a size that a slice may have, and readable by the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Places for `count` outputs, which may hold anything yet.
///
/// # Safety
/// `pointer` is null or points to memory for `count` values that nobody else uses while the slice lives.
pub(super) unsafe fn output_slice<'a, T>(
    pointer: *mut T,
    count: usize,
    name: &str,
) -> Result<&'a mut [MaybeUninit<T>], Failure> {
    check_extent::<T>(pointer.is_null(), count, name)?;
    if count == 0 {
        return Ok(&mut []);
    }
    check_alignment(pointer, name)?;
    // SAFETY: not null, aligned, of a size that a slice may have, and the caller's alone by his promise.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer.cast(), count) })
}

fn check_extent<T>(is_null: bool, count: usize, name: &str) -> Result<(), Failure> {
    if is_null && count != 0 {
        return Err(Failure::invalid(format!("{name} is null, but the count is {count}")));
    }
    if count.checked_mul(size_of::<T>()).is_none_or(|bytes| bytes > isize::MAX as usize) {
        return Err(Failure::invalid(format!("{name}: {count} of {} bytes each do not fit in memory", size_of::<T>())));
    }
    Ok(())
}

fn check_alignment<T>(pointer: *const T, name: &str) -> Result<(), Failure> {
    if pointer.is_aligned() {
        return Ok(());
    }
    Err(Failure::invalid(format!("{name} is at {pointer:p}, not a multiple of {}", align_of::<T>())))
}
