//! Texts created by the library.

use std::ffi::{CString, c_char};
use std::ptr;

use opendr::{Error, Result};
use serde::Serialize;

use crate::handle::{self, Held};
use crate::status::{guard, guard_value, opendr_status};

/// A text created by the library; free it with opendr_string_free().
pub struct opendr_string(());

/// The value of an [`opendr_string`].
pub(crate) struct Text(CString);

impl Held for Text {
    const NAME: &'static str = "opendr_string";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRtext1");
}

impl Text {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(CString::new(text.into().replace('\0', "\u{fffd}")).unwrap_or_default())
    }

    pub(crate) fn of_json(value: &impl Serialize) -> Result<Self> {
        let no_json = |error| Error::internal("the value cannot be written as JSON").with_source(error);
        serde_json::to_string(value).map(Self::new).map_err(no_json)
    }
}

/// Returns the text in UTF-8, terminated by a zero byte, or NULL if the handle is not a string; valid as long as the string.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_string_text(string: *const opendr_string) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || Ok(unsafe { handle::held::<Text, _>(string, "string") }?.0.as_ptr()))
}

/// Returns the length of the text in bytes, without the terminating zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_string_length(string: *const opendr_string) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || Ok(unsafe { handle::held::<Text, _>(string, "string") }?.0.as_bytes().len()))
}

/// Frees the string and sets the variable to NULL; does nothing if it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_string_free(string: *mut *mut opendr_string) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Text, _>(string, "string") })
}
