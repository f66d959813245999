//! Actions of policies.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::numpy_text::{Number, array_str};
use crate::target::Action;
use crate::target::json_number::null_as_nan;

/// The prediction of a policy (the paper's `RLTarget`): an element of its action space.
///
/// `{}` writes the array of its numbers.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RlTarget {
    /// Header of the observation.
    #[serde(flatten)]
    pub header: Header,
    /// Numbers of the element in the layout of the action space; for a discrete space the choice.
    #[serde(deserialize_with = "null_as_nan")]
    pub values: Vec<f32>,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl From<Vec<f32>> for RlTarget {
    fn from(values: Vec<f32>) -> Self {
        Self { values, ..Self::default() }
    }
}

target!(RlTarget, |_| None);

impl fmt::Display for RlTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&array_str(&[self.values.len()], &|at| Number::F32(self.values[at])))?;
        if f.alternate() { writeln!(f) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_arrays() {
        let target = RlTarget::from(vec![1.0, -0.25]);
        assert_eq!(target.to_string(), "[ 1.   -0.25]");
        assert_eq!(format!("{target:#}"), "[ 1.   -0.25]\n");
        assert_eq!(RlTarget::default().to_string(), "[]");
    }
}
