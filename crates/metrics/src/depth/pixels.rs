//! The pixels of a map with ground truth.

use opendr_engine::{Error, Result};

/// Returns ground truth and prediction of the pixels with finite ground truth within `range`, after a check for NaN.
pub(super) fn pairs(
    ground_truth: &[f32],
    predicted: &[f32],
    range: [f64; 2],
) -> Result<impl Iterator<Item = (f64, f64)> + Clone> {
    if ground_truth.len() != predicted.len() {
        let (expected, given) = (ground_truth.len(), predicted.len());
        return Err(Error::invalid_input(format!(
            "a map of {given} pixels cannot be compared with one of {expected}; give maps of the same size"
        )));
    }
    let all = ground_truth
        .iter()
        .zip(predicted)
        .map(|(ground_truth, predicted)| (f64::from(*ground_truth), f64::from(*predicted)));
    let valid = all.filter(move |(ground_truth, _)| {
        (range[0]..=range[1]).contains(ground_truth) && ground_truth.is_finite()
    });
    match valid.clone().any(|(_, predicted)| predicted.is_nan()) {
        true => Err(Error::invalid_input("the prediction of a pixel with ground truth is NaN; give numbers")),
        false => Ok(valid),
    }
}
