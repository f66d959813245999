//! Report of the matched classes.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::MatchedBy;

/// Maximum number of names that are printed of a list; the JSON has all.
const PRINTED: usize = 24;

/// Why classes were compared by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ByNumber {
    /// The user requested it.
    Requested,
    /// The data set has no class names.
    DatasetUnnamed,
    /// The predictions have no class names.
    LearnerUnnamed,
}

/// A class of the learner and the matching class of the data set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassPair {
    /// Name in the predictions.
    pub learner: String,
    /// Name in the data set.
    pub dataset: String,
    /// How they were matched.
    pub by: MatchedBy,
}

/// The matching of a learner's classes with those of a data set.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClassReport {
    /// Why classes were compared by number; `None` if they were compared by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_number: Option<ByNumber>,
    /// Matched classes.
    pub pairs: Vec<ClassPair>,
    /// Classes of the learner that the data set does not have. Their objects are dropped; categories and pixels of
    /// these classes count as wrong.
    pub learner_only: Vec<String>,
    /// Classes of the data set that the learner does not have.
    pub dataset_only: Vec<String>,
}

impl ClassReport {
    /// Returns whether there are no classes to report.
    pub fn is_empty(&self) -> bool {
        self.by_number.is_none() && self.pairs.is_empty() && self.learner_only.is_empty()
    }

    /// Returns the number of classes of the data set.
    fn dataset_classes(&self) -> usize {
        let mut matched: Vec<&str> = self.pairs.iter().map(|pair| pair.dataset.as_str()).collect();
        matched.sort_unstable();
        matched.dedup();
        matched.len() + self.dataset_only.len()
    }
}

/// Prints one or more lines.
impl fmt::Display for ClassReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.by_number {
            Some(ByNumber::Requested) => return writeln!(f, "classes: compared by number, as requested"),
            Some(ByNumber::DatasetUnnamed) => {
                return writeln!(f, "classes: compared by number, since the data set has no names");
            }
            Some(ByNumber::LearnerUnnamed) => {
                return writeln!(f, "classes: compared by number, since the predictions have no names");
            }
            None => {}
        }
        let all = self.dataset_classes();
        write!(f, "classes: {} of {all} of the data set matched by name", all - self.dataset_only.len())?;
        let renamed: Vec<_> = self
            .pairs
            .iter()
            .filter(|pair| pair.by != MatchedBy::Name)
            .map(|pair| format!("{} = {}", pair.learner, pair.dataset))
            .collect();
        writeln!(
            f,
            "{}",
            if renamed.is_empty() { String::new() } else { format!(" ({})", listed(&renamed)) }
        )?;
        if !self.dataset_only.is_empty() {
            writeln!(f, "  not predicted: {}", listed(&self.dataset_only))?;
        }
        if !self.learner_only.is_empty() {
            writeln!(f, "  not in the data set: {}", listed(&self.learner_only))?;
        }
        Ok(())
    }
}

/// Joins at most [`PRINTED`] names.
pub(super) fn listed<T: AsRef<str>>(names: &[T]) -> String {
    let first: Vec<_> = names.iter().take(PRINTED).map(AsRef::as_ref).collect();
    match names.len().checked_sub(PRINTED) {
        Some(more) if more > 0 => format!("{} and {more} more", first.join(", ")),
        _ => first.join(", "),
    }
}
