//! The status of calls.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use opendr::{Error, ErrorKind, Result};

use crate::pointer::text;

/// The status of a call; the numbers are the exit codes of the command `opendr`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum opendr_status {
    /// The call succeeded.
    OPENDR_OK = 0,
    /// A datum, target, pointer or file is invalid: null, wrong shape, empty, NaN, undecodable image.
    OPENDR_INVALID_INPUT = 11,
    /// A parameter is unknown, of the wrong type or out of range.
    OPENDR_INVALID_PARAM = 12,
    /// A file, model, learner, device node or class name does not exist.
    OPENDR_NOT_FOUND = 13,
    /// The operating system refused to read or write.
    OPENDR_IO = 14,
    /// A server or package client could not be reached, or the connection was lost.
    OPENDR_NETWORK = 15,
    /// A file does not match its checksum or stated size, or an archive member has a path outside its folder.
    OPENDR_INTEGRITY = 16,
    /// A file or message does not follow its format.
    OPENDR_FORMAT = 17,
    /// The learner, runtime or build does not support the request.
    OPENDR_UNSUPPORTED = 18,
    /// The requested device is not available or failed.
    OPENDR_DEVICE = 19,
    /// A bug in OpenDR: please report it.
    OPENDR_INTERNAL = 20,
}

use opendr_status::*;

impl From<ErrorKind> for opendr_status {
    fn from(kind: ErrorKind) -> Self {
        match kind {
            ErrorKind::InvalidInput => OPENDR_INVALID_INPUT,
            ErrorKind::InvalidParam => OPENDR_INVALID_PARAM,
            ErrorKind::NotFound => OPENDR_NOT_FOUND,
            ErrorKind::Io => OPENDR_IO,
            ErrorKind::Network => OPENDR_NETWORK,
            ErrorKind::Integrity => OPENDR_INTEGRITY,
            ErrorKind::Format => OPENDR_FORMAT,
            ErrorKind::Unsupported => OPENDR_UNSUPPORTED,
            ErrorKind::Device => OPENDR_DEVICE,
            _ => OPENDR_INTERNAL,
        }
    }
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Returns the message of the last failed call of this thread; "" if none failed. Valid until the next failing call of this
/// thread.
#[unsafe(no_mangle)]
pub extern "C" fn opendr_last_error() -> *const c_char {
    LAST_ERROR.try_with(|error| error.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// Sets the message that opendr_last_error() returns in this thread, for functions implemented with those of this header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_set_last_error(message: *const c_char) {
    guard_value((), || {
        // SAFETY: the rules at the top of opendr.h.
        remember(unsafe { text(message, "message") }?);
        Ok(())
    });
}

/// Returns the name of a status, e.g. "InvalidInput"; "unknown" for other numbers.
#[unsafe(no_mangle)]
pub extern "C" fn opendr_status_name(status: i32) -> *const c_char {
    const NAMES: [&CStr; 10] = [
        c"InvalidInput",
        c"InvalidParam",
        c"NotFound",
        c"Io",
        c"Network",
        c"Integrity",
        c"Format",
        c"Unsupported",
        c"Device",
        c"Internal",
    ];
    let first = OPENDR_INVALID_INPUT as i32;
    let name = status.checked_sub(first).and_then(|index| NAMES.get(usize::try_from(index).ok()?));
    match (status, name) {
        (0, _) => c"Ok".as_ptr(),
        (_, Some(name)) => name.as_ptr(),
        (_, None) => c"unknown".as_ptr(),
    }
}

/// Returns the version of the library, e.g. "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn opendr_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Runs the body of a function that returns a status; stores errors and panics for [`opendr_last_error`].
pub(crate) fn guard(body: impl FnOnce() -> Result<()>) -> opendr_status {
    match caught(body) {
        Ok(()) => OPENDR_OK,
        Err(error) => keep(&error),
    }
}

/// Runs the body of a function that returns a value; returns `failed` on errors.
pub(crate) fn guard_value<T>(failed: T, body: impl FnOnce() -> Result<T>) -> T {
    caught(body).unwrap_or_else(|error| {
        keep(&error);
        failed
    })
}

fn caught<T>(body: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| Err(error_of_panic(&*panic)))
}

fn error_of_panic(panic: &(dyn Any + Send)) -> Error {
    let message = panic.downcast_ref::<&str>().copied();
    let message = message.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("unknown");
    Error::internal(format!("a bug in OpenDR: {message}; please report it"))
}

fn keep(error: &Error) -> opendr_status {
    remember(&error.to_string());
    error.kind().into()
}

fn remember(message: &str) {
    let message = CString::new(message.replace('\0', "\u{fffd}")).unwrap_or_default();
    // The thread-local is not available while the thread ends.
    LAST_ERROR.try_with(|last| last.replace(message)).ok();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_command() {
        for number in 1..=10 {
            // SAFETY: a static text.
            let name = unsafe { CStr::from_ptr(opendr_status_name(number + 10)) };
            let kinds = [ErrorKind::InvalidInput, ErrorKind::Network, ErrorKind::Internal];
            for kind in kinds.into_iter().filter(|kind| *kind as i32 == number) {
                assert_eq!(name.to_str().unwrap(), kind.name());
                assert_eq!(opendr_status::from(kind) as i32, number + 10);
            }
        }
        for number in [i32::MIN, -1, 1, 10, 21, i32::MAX] {
            // SAFETY: a static text.
            assert_eq!(unsafe { CStr::from_ptr(opendr_status_name(number)) }, c"unknown");
        }
    }

    #[test]
    fn a_panic_is_a_status() {
        assert_eq!(guard(|| panic!("on {}", "purpose")), OPENDR_INTERNAL);
        // SAFETY: valid until the next failing call of this thread.
        let text = unsafe { CStr::from_ptr(opendr_last_error()) };
        assert!(text.to_str().unwrap().contains("on purpose"), "{text:?}");
    }
}
