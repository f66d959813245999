//! Checked conversion of pointers from C.

use std::ffi::{CStr, c_char};
use std::path::Path;
use std::slice;

use opendr::{Error, Result};

#[cold]
pub(crate) fn null(name: &str) -> Error {
    Error::invalid_input(format!("{name} is null; give a pointer"))
}

/// Returns the value that a pointer points to.
///
/// # Safety
/// It is null or points to a `T` that is not changed meanwhile.
pub(crate) unsafe fn reference<'a, T>(pointer: *const T, name: &str) -> Result<&'a T> {
    check(pointer, name)?;
    // SAFETY: not null and aligned; the rest is the caller's promise.
    Ok(unsafe { &*pointer })
}

/// Returns a pointer to write to; the memory may be uninitialised.
///
/// # Errors
/// `InvalidInput` when it is null or unaligned.
pub(crate) fn place<T>(pointer: *mut T, name: &str) -> Result<*mut T> {
    check(pointer, name).map(|()| pointer)
}

fn check<T>(pointer: *const T, name: &str) -> Result<()> {
    if pointer.is_null() {
        return Err(null(name));
    }
    if !pointer.is_aligned() {
        return Err(Error::invalid_input(format!("{name} is not aligned; give a pointer to its own type")));
    }
    Ok(())
}

/// Returns a slice of `count` items; `pointer` may be null if `count` is 0.
///
/// # Safety
/// `pointer` points to `count` items that are not changed meanwhile.
pub(crate) unsafe fn slice<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, name)?;
    let bytes = count.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| bytes > isize::MAX as usize - pointer.addr().min(isize::MAX as usize)) {
        return Err(Error::invalid_input(format!(
            "{name} of {count} items exceeds the address space; give the actual count"
        )));
    }
    // SAFETY: not null, aligned, no longer than the address space; the rest is the caller's promise.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// Returns a text in UTF-8.
///
/// # Safety
/// It is null or ends with a zero byte, and is not changed meanwhile.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str> {
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| {
        Error::invalid_input(format!("{name} is not UTF-8: {}; give it in UTF-8", text.to_string_lossy()))
    })
}

/// Returns a text, or `None` for null.
///
/// # Safety
/// The same as for [`text`].
pub(crate) unsafe fn optional_text<'a>(pointer: *const c_char, name: &str) -> Result<Option<&'a str>> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { text(pointer, name) }.map(Some)
}

/// Returns a path: any bytes on systems with such file names, else UTF-8.
///
/// # Safety
/// The same as for [`text`].
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
