//! Texts that the library made.

use std::ffi::{CString, c_char};
use std::ptr;

use opendr::{Error, Result};
use serde::Serialize;

use crate::handle::{self, Held};
use crate::status::{guard, guard_value, opendr_status};

/// A text that the library made; free it with opendr_string_free().
pub struct opendr_string(());

/// What an [`opendr_string`] holds.
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
        let no_json = |error| Error::internal("a value has no JSON form").with_source(error);
        serde_json::to_string(value).map(Self::new).map_err(no_json)
    }
}

/// The bytes of the text in UTF-8, ended by a zero; NULL for what is no string. They live as long as the string.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_string_text(string: *const opendr_string) -> *const c_char {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(ptr::null(), || Ok(unsafe { handle::held::<Text, _>(string, "string") }?.0.as_ptr()))
}

/// How many bytes the text has, the zero at its end not counted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_string_length(string: *const opendr_string) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || Ok(unsafe { handle::held::<Text, _>(string, "string") }?.0.as_bytes().len()))
}

/// Frees the string and makes the variable NULL; a NULL in it is freed already.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_string_free(string: *mut *mut opendr_string) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Text, _>(string, "string") })
}
