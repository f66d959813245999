//! What C hands in, checked as far as it can be.

use std::ffi::{CStr, c_char};
use std::path::Path;
use std::slice;

use opendr::{Error, Result};

#[cold]
pub(crate) fn null(name: &str) -> Error {
    Error::invalid_input(format!("{name} is null; give a pointer"))
}

/// What a pointer leads to.
///
/// # Safety
/// It is null or leads to a `T` that nobody changes meanwhile.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T, name: &str) -> Result<&'a T> {
    check(pointer, name)?;
    // SAFETY: not null and aligned; the rest is the caller's promise.
    Ok(unsafe { &*pointer })
}

/// A place to write to, which may hold anything yet.
///
/// # Errors
/// `InvalidInput` when it is null or crooked.
pub(crate) fn place<T>(pointer: *mut T, name: &str) -> Result<*mut T> {
    check(pointer, name).map(|()| pointer)
}

fn check<T>(pointer: *const T, name: &str) -> Result<()> {
    if pointer.is_null() {
        return Err(null(name));
    }
    if !pointer.is_aligned() {
        return Err(Error::invalid_input(format!("{name} is no valid pointer; give one from its own type")));
    }
    Ok(())
}

/// As many items as C says there are; null is nothing when there are none.
///
/// # Safety
/// `pointer` leads to `count` items that nobody changes meanwhile.
pub(crate) unsafe fn slice<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, name)?;
    let bytes = count.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| bytes > isize::MAX as usize - pointer.addr().min(isize::MAX as usize)) {
        return Err(Error::invalid_input(format!(
            "{name} of {count} items do not fit in memory; give their true number"
        )));
    }
    // SAFETY: not null, aligned, no longer than the address space; the rest is the caller's promise.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// A text in UTF-8.
///
/// # Safety
/// It is null or ends with a zero byte, and nobody changes it meanwhile.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str> {
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| {
        Error::invalid_input(format!("{name} is no UTF-8: {}; write it in UTF-8", text.to_string_lossy()))
    })
}

/// A text that may be left out by null.
///
/// # Safety
/// As [`text`].
pub(crate) unsafe fn optional_text<'a>(pointer: *const c_char, name: &str) -> Result<Option<&'a str>> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { text(pointer, name) }.map(Some)
}

/// A path: any bytes where the system has such names, else UTF-8.
///
/// # Safety
/// As [`text`].
pub(crate) unsafe fn path<'a>(pointer: *const c_char, name: &str) -> Result<&'a Path> {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;

        if pointer.is_null() {
            return Err(null(name));
        }
        // SAFETY: the caller's promise.
        let bytes = unsafe { CStr::from_ptr(pointer) }.to_bytes();
        Ok(Path::new(std::ffi::OsStr::from_bytes(bytes)))
    }
    #[cfg(not(unix))]
    // SAFETY: the caller's promise.
    unsafe { text(pointer, name) }.map(Path::new)
}
