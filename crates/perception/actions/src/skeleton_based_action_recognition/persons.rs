//! Predictions for a recording from those for its persons.

use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Result};
use opendr_perception_common::category_scores::category_from_logits;

/// Adds the logits of one person to `sum`.
pub(super) fn add_to(sum: &mut Vec<f32>, logits: &[f32]) {
    sum.resize(logits.len(), 0.0);
    sum.iter_mut().zip(logits).for_each(|(sum, logit)| *sum += logit);
}

/// Writes the category of the mean logits of `persons` into `category`; `sum` is their sum.
///
/// # Errors
/// `InvalidInput` when `persons` is zero.
pub(super) fn mean_category(
    category: &mut Category,
    sum: &mut [f32],
    persons: usize,
    classes: &Classes,
) -> Result<()> {
    if persons == 0 {
        return Err(Error::invalid_input(
            "the recording has no person: all joints are missing; skip such recordings",
        ));
    }
    sum.iter_mut().for_each(|logit| *logit /= persons as f32);
    category_from_logits(category, sum, classes)
}
