//! Parameters of networks in the files of a container.

use opendr_engine::{Error, Result};

/// Parses `count` little-endian `f32`; `what` names them in the error.
pub fn parse(what: &str, bytes: &[u8], count: usize) -> Result<Vec<f32>> {
    let (values, rest) = bytes.as_chunks::<4>();
    let values: Vec<f32> = values.iter().map(|value| f32::from_le_bytes(*value)).collect();
    if values.len() != count || !rest.is_empty() || values.iter().any(|value| !value.is_finite()) {
        return Err(Error::format(format!(
            "{what} has {} bytes, or numbers that are not finite; its sizes need {count} numbers of 4 bytes: train the model again",
            bytes.len()
        )));
    }
    Ok(values)
}
