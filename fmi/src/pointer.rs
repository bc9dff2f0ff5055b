//! Checked conversion of the importer's pointers to references.

use std::ffi::{CStr, c_char, c_void};

use crate::error::CallError;

/// Handles empty arrays and rejects lengths that no allocation can have.
fn checked<T>(argument: &'static str, is_null: bool, count: usize) -> Result<(), CallError> {
    if is_null {
        return Err(CallError::NullPointer { argument });
    }
    // from_raw_parts demands it
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(CallError::TooMany { argument, count });
    }
    Ok(())
}

/// An array that the importer passes for reading.
///
/// # Safety
/// If not NULL, `pointer` must be valid for reads of `count` elements during the call.
pub(crate) unsafe fn array<'a, T>(
    argument: &'static str,
    pointer: *const T,
    count: usize,
) -> Result<&'a [T], CallError> {
    if count == 0 {
        return Ok(&[]);
    }
    checked::<T>(argument, pointer.is_null(), count)?;
    // SAFETY: not NULL and not too long; the rest is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// An array that the importer passes for writing.
///
/// # Safety
/// If not NULL, `pointer` must be valid for writes of `count` elements during the call, and not alias
/// other arguments.
pub(crate) unsafe fn array_mut<'a, T>(
    argument: &'static str,
    pointer: *mut T,
    count: usize,
) -> Result<&'a mut [T], CallError> {
    if count == 0 {
        return Ok(&mut []);
    }
    checked::<T>(argument, pointer.is_null(), count)?;
    // SAFETY: not NULL and not too long; the rest is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) })
}

/// One value that the importer passes for reading.
///
/// # Safety
/// If not NULL, `pointer` must be valid for reads during the call.
pub(crate) unsafe fn reference<'a, T>(argument: &'static str, pointer: *const T) -> Result<&'a T, CallError> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_ref() }.ok_or(CallError::NullPointer { argument })
}

/// One value that the importer passes for writing.
///
/// # Safety
/// If not NULL, `pointer` must be valid for reads and writes during the call, and not alias other
/// arguments.
pub(crate) unsafe fn reference_mut<'a, T>(
    argument: &'static str,
    pointer: *mut T,
) -> Result<&'a mut T, CallError> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_mut() }.ok_or(CallError::NullPointer { argument })
}

/// A string that the importer passes.
///
/// # Safety
/// If not NULL, `pointer` must point at a NUL-terminated string that is valid during the call.
pub(crate) unsafe fn string<'a>(
    argument: &'static str,
    pointer: *const c_char,
) -> Result<&'a CStr, CallError> {
    if pointer.is_null() {
        return Err(CallError::NullPointer { argument });
    }
    // SAFETY: not NULL; the rest is the caller's promise.
    Ok(unsafe { CStr::from_ptr(pointer) })
}

/// Passes ownership of `value` to the importer, in the allocation that `slot` already holds or in a new one.
///
/// # Safety
/// `slot` must hold NULL or a pointer that this function put there for the same `T`.
pub(crate) unsafe fn keep<T>(slot: &mut *mut c_void, value: T) {
    if slot.is_null() {
        *slot = Box::into_raw(Box::new(value)).cast();
    } else {
        // SAFETY: the caller's promise.
        unsafe { *slot.cast::<T>() = value };
    }
}

/// Frees what [`keep`] stored, and stores NULL. Freeing NULL does nothing.
///
/// # Safety
/// As for [`keep`]; `slot` itself may be NULL.
pub(crate) unsafe fn release<T>(slot: *mut *mut c_void) {
    // SAFETY: the caller's promise.
    let Some(slot) = (unsafe { slot.as_mut() }) else { return };
    let pointer = std::mem::replace(slot, std::ptr::null_mut()).cast::<T>();
    if !pointer.is_null() {
        // SAFETY: it came from Box::into_raw in `keep`, and cannot be reached again.
        drop(unsafe { Box::from_raw(pointer) });
    }
}
