//! Categories: the class of a whole input.

use std::ffi::c_char;

use opendr::target::Category;
use opendr::{Error, Result};

use crate::handle::Out;
use crate::pointer::{optional_text, place, reference, slice};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_category};

/// The fields of a category.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_category_fields {
    /// Class index.
    pub class_index: i64,
    /// Name of the class; NULL when unknown.
    pub description: *const c_char,
    /// Score of the class, 0 to 1; NaN if there is none.
    pub confidence: f32,
    /// Scores of all classes.
    pub probabilities: *const f32,
    /// Number of probabilities; 0 if the learner predicts none.
    pub probability_count: usize,
}

/// Creates a category; the fields are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_category_create(
    fields: *const opendr_category_fields,
    category: *mut *mut opendr_category,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, fields) = unsafe { (Out::new(category, "category")?, reference(fields, "fields")?) };
        // SAFETY: the rules at the top of opendr.h.
        out.set(AnyValue::from(unsafe { fields.to_category() }?));
        Ok(())
    })
}

/// Writes the fields of a category; their pointers are valid as long as the category.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_category_read(
    category: *const opendr_category,
    fields: *mut opendr_category_fields,
) -> opendr_status {
    guard(|| {
        let place = place(fields, "fields")?;
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(category, "category") }?;
        let category = value.typed::<Category>("category")?;
        let fields = opendr_category_fields {
            class_index: category.class,
            description: value.texts.keep_optional(category.description.as_deref()),
            confidence: category.confidence.unwrap_or(f32::NAN),
            probabilities: category.probabilities.as_ptr(),
            probability_count: category.probabilities.len(),
        };
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(fields) };
        Ok(())
    })
}

impl opendr_category_fields {
    /// # Safety
    /// Its pointers are valid.
    unsafe fn to_category(self) -> Result<Category> {
        // SAFETY: the caller's promise.
        let (description, probabilities) = unsafe {
            (
                optional_text(self.description, "description")?,
                slice(self.probabilities, self.probability_count, "probabilities")?,
            )
        };
        if self.confidence.is_infinite() {
            return Err(Error::invalid_input("confidence is infinite; give 0 to 1, or NaN for none"));
        }
        Ok(Category {
            description: description.map(Into::into),
            probabilities: probabilities.to_vec(),
            ..Category::new(self.class_index, Some(self.confidence).filter(|score| !score.is_nan()))
        })
    }
}
