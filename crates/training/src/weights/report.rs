//! Report of an import of weights.

use std::fmt;

use opendr_engine::{Error, Result};

/// A weight whose shape differs from that of its parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mismatch {
    /// Name of the parameter in the module.
    pub parameter: String,
    /// Shape in the module.
    pub expected: Vec<usize>,
    /// Shape in the file.
    pub actual: Vec<usize>,
}

/// Result of an import: loaded, missing, mismatched and unused weights.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Report {
    /// Parameters with values from the file, by the module's names.
    pub loaded: Vec<String>,
    /// Parameters without a weight in the file, by the module's names; they are unchanged.
    pub missing: Vec<String>,
    /// Parameters for which the file has another shape; they are unchanged.
    pub mismatched: Vec<Mismatch>,
    /// Unused weights, by the file's names.
    pub unexpected: Vec<String>,
}

/// Maximum number of names in a message.
const MAX_NAMES: usize = 3;

impl Report {
    /// Checks that every parameter covered by the rules has its values from the file.
    ///
    /// # Errors
    /// `InvalidInput` with the names of the first parameters that have none.
    pub fn complete(&self) -> Result<()> {
        if let Some(Mismatch { parameter, expected: wanted, actual: given }) = self.mismatched.first() {
            return Err(Error::invalid_input(format!(
                "{} weights do not fit: {parameter} is {wanted:?} in the network and {given:?} in the file",
                self.mismatched.len()
            )));
        }
        match self.missing.len() {
            0 => Ok(()),
            count => Err(Error::invalid_input(format!(
                "the file has no weights for {count} of {} parameters: {}; {} of its weights are unused: {}",
                count + self.loaded.len(),
                first(&self.missing),
                self.unexpected.len(),
                first(&self.unexpected),
            ))),
        }
    }
}

fn first(names: &[String]) -> String {
    let mut text = names.iter().take(MAX_NAMES).map(String::as_str).collect::<Vec<_>>().join(", ");
    if names.len() > MAX_NAMES {
        text += ", ...";
    }
    text
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { loaded: taken, missing, mismatched, unexpected: left } = self;
        let all = taken.len() + missing.len() + mismatched.len();
        write!(f, "{} of {all} parameters loaded", taken.len())?;
        if !missing.is_empty() {
            write!(f, "; missing: {}", first(missing))?;
        }
        if let [Mismatch { parameter, expected: wanted, actual: given }, ..] = &mismatched[..] {
            write!(f, "; {} of another shape: {parameter} ({given:?} for {wanted:?})", mismatched.len())?;
        }
        if !left.is_empty() {
            write!(f, "; {} weights unused: {}", left.len(), first(left))?;
        }
        Ok(())
    }
}
