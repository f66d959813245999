//! Integration tests of this crate, in one program to link only once.

#![allow(clippy::unwrap_used)]

mod corpus;
mod misuse;
mod network;

use std::ffi::CStr;

use opendr_c::{opendr_last_error, opendr_status};

fn last_error() -> String {
    // SAFETY: valid until the next failing call of this thread.
    unsafe { CStr::from_ptr(opendr_last_error()) }.to_str().unwrap().to_owned()
}

/// Asserts that a call fails with the given status and that its message contains the given words.
#[track_caller]
fn refused(status: opendr_status, wanted: opendr_status, words: &str) {
    assert_eq!(status, wanted, "{}", last_error());
    assert!(last_error().contains(words), "{:?} lacks {words:?}", last_error());
}
