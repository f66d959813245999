//! Which classes were compared with which.

use std::fmt;

use serde::Serialize;

use super::MatchedBy;

/// Names that are printed of a list; the report in JSON has all.
const PRINTED: usize = 24;

/// Why numbers were compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ByNumber {
    /// The user asked for it.
    Asked,
    /// The data set names no classes.
    DatasetUnnamed,
    /// The predictions name no classes.
    LearnerUnnamed,
}

/// A class of the learner and the one of the data set that it was compared with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ClassPair {
    /// Name in the predictions.
    pub learner: String,
    /// Name in the data set.
    pub dataset: String,
    /// How it was found.
    pub by: MatchedBy,
}

/// The map that was used from a learner's classes to those of a data set.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct ClassReport {
    /// Why classes were compared by their numbers; `None` where they were compared by their names.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_number: Option<ByNumber>,
    /// Classes that were compared.
    pub pairs: Vec<ClassPair>,
    /// Classes of the learner that the data set does not have. Objects of these classes are left out; a category or a pixel of
    /// such a class is wrong.
    pub learner_only: Vec<String>,
    /// Classes of the data set that the learner does not have: it cannot find them.
    pub dataset_only: Vec<String>,
}

impl ClassReport {
    /// Whether there are classes to speak of.
    pub fn is_empty(&self) -> bool {
        self.by_number.is_none() && self.pairs.is_empty() && self.learner_only.is_empty()
    }

    /// Classes of the data set.
    fn dataset_classes(&self) -> usize {
        let mut matched: Vec<&str> = self.pairs.iter().map(|pair| pair.dataset.as_str()).collect();
        matched.sort_unstable();
        matched.dedup();
        matched.len() + self.dataset_only.len()
    }
}

/// One or more lines for the screen.
impl fmt::Display for ClassReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.by_number {
            Some(ByNumber::Asked) => return writeln!(f, "classes: compared by number, as asked"),
            Some(ByNumber::DatasetUnnamed) => {
                return writeln!(f, "classes: compared by number, since the data set names none");
            }
            Some(ByNumber::LearnerUnnamed) => {
                return writeln!(f, "classes: compared by number, since the predictions name none");
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

/// Names one after the other, at most [`PRINTED`].
pub(super) fn listed<T: AsRef<str>>(names: &[T]) -> String {
    let first: Vec<_> = names.iter().take(PRINTED).map(AsRef::as_ref).collect();
    match names.len().checked_sub(PRINTED) {
        Some(more) if more > 0 => format!("{} and {more} more", first.join(", ")),
        _ => first.join(", "),
    }
}
