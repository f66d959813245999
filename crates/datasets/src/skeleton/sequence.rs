//! Sequences of finite values.

use opendr_engine::data::SkeletonSequence;
use opendr_engine::{Error, Result};

/// Creates a sequence; all values must be finite.
pub(super) fn finite_sequence(numbers: &[f64], shape: [usize; 5]) -> Result<SkeletonSequence> {
    if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
        return Err(Error::format(format!("value {at} is NaN or infinite; fix or remove the recording")));
    }
    SkeletonSequence::new(numbers.iter().map(|number| *number as f32).collect::<Vec<_>>(), shape)
}
