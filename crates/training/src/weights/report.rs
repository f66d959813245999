//! What became of the weights of a file.

use std::fmt;

use opendr_engine::{Error, Result};

/// A weight that does not fit the parameter of its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mismatch {
    /// The module's name of the parameter.
    pub parameter: String,
    /// Its shape in the module.
    pub wanted: Vec<usize>,
    /// Its shape in the file.
    pub given: Vec<usize>,
}

/// What was taken, what was left, and what is missing.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Report {
    /// Parameters that have their values from the file now, by the module's names.
    pub taken: Vec<String>,
    /// Parameters that the file has nothing for, by the module's names; they are as they were.
    pub missing: Vec<String>,
    /// Parameters for which the file has another shape; they are as they were.
    pub mismatched: Vec<Mismatch>,
    /// Weights that went nowhere, by the file's names.
    pub left: Vec<String>,
}

/// How many names a message shows.
const SHOWN: usize = 3;

impl Report {
    /// The report, when every parameter that the rules cover has its values from the file.
    ///
    /// # Errors
    /// `InvalidInput` that names the first ones that have none.
    pub fn complete(&self) -> Result<()> {
        if let Some(Mismatch { parameter, wanted, given }) = self.mismatched.first() {
            return Err(Error::invalid_input(format!(
                "{} weights do not fit: {parameter} is {wanted:?} in the network and {given:?} in the file",
                self.mismatched.len()
            )));
        }
        match self.missing.len() {
            0 => Ok(()),
            count => Err(Error::invalid_input(format!(
                "the file has no weights for {count} of {} parameters: {}; its own {} were left: {}",
                count + self.taken.len(),
                first(&self.missing),
                self.left.len(),
                first(&self.left),
            ))),
        }
    }
}

fn first(names: &[String]) -> String {
    let mut text = names.iter().take(SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN {
        text += ", ...";
    }
    text
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { taken, missing, mismatched, left } = self;
        let all = taken.len() + missing.len() + mismatched.len();
        write!(f, "{} of {all} parameters taken", taken.len())?;
        if !missing.is_empty() {
            write!(f, "; missing: {}", first(missing))?;
        }
        if let [Mismatch { parameter, wanted, given }, ..] = &mismatched[..] {
            write!(f, "; {} of another shape: {parameter} ({given:?} for {wanted:?})", mismatched.len())?;
        }
        if !left.is_empty() {
            write!(f, "; {} weights left: {}", left.len(), first(left))?;
        }
        Ok(())
    }
}
