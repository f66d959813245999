//! Classes of whole inputs, for recognition and classification.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::header::optional_text;
use crate::numpy_text::{Number, array_str, python_float};
use crate::target::Action;
use crate::target::json_number::null_as_nan;

/// The class of a datum.
///
/// `{}` writes OpenDR's text, e.g. `Class 3 (cat) with confidence 0.9`; `{:#}` writes `cat 0.90`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Category {
    /// Header of the datum.
    #[serde(flatten)]
    pub header: Header,
    /// Class index (OpenDR's `data`).
    pub class: i64,
    /// Name of the class.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "optional_text")]
    pub description: Option<Arc<str>>,
    /// Score of the class, 0..=1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f32>,
    /// Score of every class, if the learner provides them (OpenDR's `confidence` as a vector).
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "null_as_nan")]
    pub probabilities: Vec<f32>,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl Category {
    /// Creates a category without name and scores.
    pub fn new(class: i64, confidence: Option<f32>) -> Self {
        Self { class, confidence, ..Self::default() }
    }
}

target!(Category, |category| category.confidence);

impl fmt::Display for Category {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            match &self.description {
                Some(description) => f.write_str(description)?,
                None => write!(f, "class {}", self.class)?,
            }
            return match self.confidence {
                Some(confidence) => writeln!(f, " {confidence:.2}"),
                None => writeln!(f),
            };
        }
        let confidence = match self.confidence {
            Some(confidence) => Some(python_float(confidence)),
            None if self.probabilities.is_empty() => None,
            None => {
                let count = self.probabilities.len();
                Some(array_str(&[count], &|at| Number::F32(self.probabilities[at])))
            }
        };
        match (&self.description, confidence) {
            (None, Some(confidence)) => write!(f, "Class {} with confidence {confidence}", self.class),
            (None, None) => write!(f, "Class {} ", self.class),
            (Some(description), Some(confidence)) => {
                write!(f, "Class {} ({description}) with confidence {confidence}", self.class)
            }
            (Some(description), None) => write!(f, "Class {}, ({description})", self.class),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_forms() {
        let described = |class, confidence| Category {
            description: Some("cat".into()),
            ..Category::new(class, confidence)
        };
        assert_eq!(Category::new(3, Some(0.9)).to_string(), "Class 3 with confidence 0.9");
        assert_eq!(Category::new(3, None).to_string(), "Class 3 ");
        assert_eq!(described(3, Some(1.0)).to_string(), "Class 3 (cat) with confidence 1.0");
        assert_eq!(described(3, None).to_string(), "Class 3, (cat)");
        assert_eq!(format!("{:#}", described(3, Some(0.906))), "cat 0.91\n");
        let probabilities = vec![0.25, 0.75];
        let vector = Category { probabilities, ..Category::new(1, None) };
        assert_eq!(vector.to_string(), "Class 1 with confidence [0.25 0.75]");
    }
}
