//! Checks of parameters and series against a model or the data.

use opendr_engine::data::Timeseries;
use opendr_engine::{Error, Result};

/// Checks a size that the user gave, where there is one, against the model or the data.
///
/// # Errors
/// `InvalidParam` when they differ.
pub fn check_size(name: &str, wanted: Option<usize>, actual: usize) -> Result<()> {
    match wanted {
        Some(wanted) if wanted != actual => Err(Error::invalid_param(format!(
            "{name} = {wanted}, but it is {actual} here; omit {name}, or choose another model or data set"
        ))),
        _ => Ok(()),
    }
}

/// Checks that a series has no missing measurements.
///
/// # Errors
/// `InvalidInput` for a value that is not finite.
pub fn check_finite(series: &Timeseries) -> Result<()> {
    match series.as_slice().iter().position(|number| !number.is_finite()) {
        Some(at) => Err(Error::invalid_input(format!(
            "measurement {at} of the series is {}; fill in missing values",
            series.as_slice()[at]
        ))),
        None => Ok(()),
    }
}
