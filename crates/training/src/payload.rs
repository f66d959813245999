//! Bytes that processes of a training send each other.

use opendr_engine::{Error, Result};

/// Returns the error of a payload that is too short.
pub fn truncated() -> Error {
    Error::format("the payload of another process of the training is cut off")
}

/// Takes `N` bytes.
///
/// # Errors
/// `Format` where there are fewer.
pub fn take<const N: usize>(bytes: &mut &[u8]) -> Result<[u8; N]> {
    let (taken, rest) = bytes.split_first_chunk::<N>().ok_or_else(truncated)?;
    *bytes = rest;
    Ok(*taken)
}

/// Takes a `u64`.
///
/// # Errors
/// `Format` where there are fewer bytes.
pub fn number(bytes: &mut &[u8]) -> Result<u64> {
    take(bytes).map(u64::from_le_bytes)
}

/// Takes `count` numbers.
///
/// # Errors
/// `Format` where there are fewer.
pub fn floats(bytes: &mut &[u8], count: usize) -> Result<Vec<f32>> {
    let (taken, rest) = bytes.split_at_checked(4 * count).ok_or_else(truncated)?;
    *bytes = rest;
    Ok(taken.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
}

/// Appends numbers.
pub fn write_floats(values: &[f32], bytes: &mut Vec<u8>) {
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
}
