//! Targets: what learners answer. One file per type.

mod bounding_box_3d_list;
mod bounding_box_list;
mod category;
mod heatmap;
mod list;
mod pose_list;
mod rl_target;
mod speech_command;
mod tracking_annotation_3d_list;
mod tracking_annotation_list;
mod transcription;

pub use bounding_box_3d_list::*;
pub use bounding_box_list::*;
pub use category::*;
pub use heatmap::*;
pub use pose_list::*;
pub use rl_target::*;
pub use speech_command::*;
pub use tracking_annotation_3d_list::*;
pub use tracking_annotation_list::*;
pub use transcription::*;

use std::ffi::c_char;

use opendr::target::{Classes, Name};
use opendr::{Error, Result};

use crate::pointer::optional_text;
use crate::texts::Texts;

/// A class as C has it: its number, -1 for a label alone, and its label or null.
fn class_of_name(name: &Name, classes: &Classes, texts: &Texts) -> (i64, *const c_char) {
    let index = if let Name::Index(index) = name { *index } else { -1 };
    (index, texts.keep_optional(classes.label(name)))
}

/// A class from C: the label counts where there is no number.
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

/// Refuses numbers that lie nowhere.
fn check_finite(numbers: &[f32], what: &str) -> Result<()> {
    if numbers.iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    Err(Error::invalid_input(format!("{what} has {numbers:?}; give finite numbers")))
}

/// A number that C writes -1 when it is not known.
fn known(number: i64) -> Option<i64> {
    (number >= 0).then_some(number)
}
