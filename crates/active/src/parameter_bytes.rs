//! Parameters of networks in the files of a container.

use half::f16;
use opendr_engine::{Error, Result};

/// Rounds parameters to half precision, in which files have them: a network that was trained then computes what the network of
/// its file computes.
pub fn round(parameters: &mut [f32]) {
    for parameter in parameters {
        *parameter = f16::from_f32(*parameter).to_f32();
    }
}

/// Returns parameters as little-endian `f16`.
pub fn write(parameters: &[f32]) -> Vec<u8> {
    parameters.iter().flat_map(|parameter| f16::from_f32(*parameter).to_le_bytes()).collect()
}

/// Parses `count` little-endian `f16`; `what` names them in the error.
pub fn parse(what: &str, bytes: &[u8], count: usize) -> Result<Vec<f32>> {
    let (values, rest) = bytes.as_chunks::<2>();
    let values: Vec<f32> = values.iter().map(|value| f16::from_le_bytes(*value).to_f32()).collect();
    if values.len() != count || !rest.is_empty() || values.iter().any(|value| !value.is_finite()) {
        return Err(Error::format(format!(
            "{what} has {} bytes, or numbers that are not finite; its sizes need {count} numbers of 2 bytes: train the model again",
            bytes.len()
        )));
    }
    Ok(values)
}
