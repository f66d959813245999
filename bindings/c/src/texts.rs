//! Texts returned to C, valid as long as their owner.

use std::collections::BTreeMap;
use std::ffi::{CString, c_char};
use std::sync::{Mutex, PoisonError};

/// Texts that end with a zero byte, each created once and never moved.
#[derive(Default)]
pub(crate) struct Texts(Mutex<BTreeMap<Box<str>, CString>>);

impl Texts {
    /// Returns the text for C, valid as long as `self`.
    pub(crate) fn keep(&self, text: &str) -> *const c_char {
        let mut texts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kept) = texts.get(text) {
            return kept.as_ptr();
        }
        let kept = CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default();
        texts.entry(text.into()).or_insert(kept).as_ptr()
    }

    /// Returns the text for C, or null.
    pub(crate) fn keep_optional(&self, text: Option<&str>) -> *const c_char {
        text.map_or(std::ptr::null(), |text| self.keep(text))
    }
}
