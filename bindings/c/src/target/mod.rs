//! Target types, of predictions and annotations. One file per type.

mod bounding_box_3d_list;
mod bounding_box_list;
mod category;
mod heatmap;
mod list;
mod odometry;
mod pose_list;
mod rl_target;
mod speech_command;
mod text_region_list;
mod tracking_annotation_3d_list;
mod tracking_annotation_list;
mod transcription;

pub use bounding_box_3d_list::*;
pub use bounding_box_list::*;
pub use category::*;
pub use heatmap::*;
pub use odometry::*;
pub use pose_list::*;
pub use rl_target::*;
pub use speech_command::*;
pub use text_region_list::*;
pub use tracking_annotation_3d_list::*;
pub use tracking_annotation_list::*;
pub use transcription::*;

use std::ffi::c_char;

use opendr::target::{Classes, Name};
use opendr::{Error, Result};

use crate::pointer::optional_text;
use crate::texts::Texts;

/// Converts a class for C: its index, -1 if there is only a label, and its label or null.
fn class_of_name(name: &Name, classes: &Classes, texts: &Texts) -> (i64, *const c_char) {
    let index = if let Name::Index(index) = name { *index } else { -1 };
    (index, texts.keep_optional(classes.label(name)))
}

/// Converts a class from C: the label is used if there is no index.
///
/// # Safety
/// `label` is null or a text.
unsafe fn name_of_class(class_index: i64, label: *const c_char) -> Result<Name> {
    // SAFETY: the caller's promise.
    match unsafe { optional_text(label, "label") }? {
        Some(label) if class_index < 0 => Ok(Name::from(label)),
        _ => Ok(Name::Index(class_index)),
    }
}

/// Checks that numbers are finite.
fn check_finite(numbers: &[f32], what: &str) -> Result<()> {
    if numbers.iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    Err(Error::invalid_input(format!("{what} has {numbers:?}; give finite numbers")))
}

/// Converts an index of C, where -1 is unknown.
fn known(number: i64) -> Option<i64> {
    (number >= 0).then_some(number)
}
