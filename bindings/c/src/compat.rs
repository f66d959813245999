//! Access to the values of a model's JSON, for the headers with OpenDR's own names (`include/opendr`).

use std::cell::RefCell;
use std::ffi::{CString, c_char};

use opendr::{Error, Result};
use serde_json::Value;

use crate::pointer::{optional_text, text};
use crate::status::guard_value;

thread_local! {
    static LAST_TEXT: RefCell<CString> = RefCell::default();
}

/// Returns the text under a key of a JSON object, or of the object under section if that is not NULL; of a list, the item at
/// index. Returns "" if there is none. Valid until the next call of this thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_json_text(
    json: *const c_char,
    section: *const c_char,
    key: *const c_char,
    index: i32,
) -> *const c_char {
    guard_value(c"".as_ptr(), || {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { json_value(json, section, key, index) }?;
        let found = value
            .as_str()
            .ok_or_else(|| Error::not_found("the value of this key is not a text; give another key"))?;
        let found = CString::new(found.replace('\0', "\u{fffd}")).unwrap_or_default();
        let kept = LAST_TEXT.try_with(|last| {
            last.replace(found);
            last.borrow().as_ptr()
        });
        Ok(kept.unwrap_or(c"".as_ptr()))
    })
}

/// Returns the number under a key, with the arguments of opendr_json_text(); 0 if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_json_number(
    json: *const c_char,
    section: *const c_char,
    key: *const c_char,
    index: i32,
) -> f64 {
    guard_value(0.0, || {
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { json_value(json, section, key, index) }?;
        value
            .as_f64()
            .ok_or_else(|| Error::not_found("the value of this key is not a number; give another key"))
    })
}

/// # Safety
/// The pointers are null or texts.
unsafe fn json_value(
    json: *const c_char,
    section: *const c_char,
    key: *const c_char,
    index: i32,
) -> Result<Value> {
    // SAFETY: the caller's promise.
    let (json, section, key) =
        unsafe { (text(json, "json")?, optional_text(section, "section")?, text(key, "key")?) };
    let mut value: Value = serde_json::from_str(json)
        .map_err(|error| Error::format("json is not valid JSON").with_source(error))?;
    let missing = |name: &str| Error::not_found(format!("there is no key {name:?}; give an existing key"));
    for name in section.into_iter().chain([key]) {
        value = value.get_mut(name).map(Value::take).ok_or_else(|| missing(name))?;
    }
    match value {
        Value::Array(mut items) => {
            let item = usize::try_from(index).ok().and_then(|index| items.get_mut(index));
            item.map(Value::take).ok_or_else(|| missing(&format!("{key}[{index}]")))
        }
        other => Ok(other),
    }
}
