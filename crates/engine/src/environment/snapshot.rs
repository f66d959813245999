//! Saved states of environments.

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// A saved state of an environment, as 64-bit words, so that numbers keep every bit in any file format.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Snapshot {
    id: String,
    words: Vec<u64>,
}

impl Snapshot {
    /// Creates an empty snapshot of the environment `id`.
    pub fn new(id: &str) -> Self {
        Self { id: id.to_owned(), words: Vec::new() }
    }

    /// Returns the id of its environment.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Appends a word.
    pub fn push(&mut self, word: u64) {
        self.words.push(word);
    }

    /// Appends a number.
    pub fn push_number(&mut self, number: f64) {
        self.words.push(number.to_bits());
    }

    /// Appends several numbers.
    pub fn extend_numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.words.extend(numbers.into_iter().map(f64::to_bits));
    }

    /// Returns a reader of the state for the environment `id`.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a snapshot of another environment.
    pub fn read(&self, id: &str) -> Result<StateReader<'_>> {
        if self.id != id {
            let own = &self.id;
            return Err(Error::invalid_input(format!(
                "a snapshot of {own} cannot be restored in {id}; create {own:?} and restore it there"
            )));
        }
        Ok(StateReader { words: &self.words })
    }
}

/// Reads a [`Snapshot`] in the order in which it was written.
#[derive(Debug)]
pub struct StateReader<'a> {
    words: &'a [u64],
}

impl StateReader<'_> {
    /// Returns the next word.
    ///
    /// # Errors
    /// Returns `Format` at the end.
    pub fn word(&mut self) -> Result<u64> {
        let (word, rest) = self.words.split_first().ok_or_else(|| {
            Error::format(
                "the snapshot ends too early; create the snapshot again with this version of the environment",
            )
        })?;
        self.words = rest;
        Ok(*word)
    }

    /// Returns the next number.
    ///
    /// # Errors
    /// Returns `Format` at the end.
    pub fn number(&mut self) -> Result<f64> {
        self.word().map(f64::from_bits)
    }

    /// Returns the next number, which must be finite: other states would corrupt an episode without an error.
    ///
    /// # Errors
    /// Returns `Format` at the end and for NaN and infinities.
    pub fn finite(&mut self) -> Result<f64> {
        let number = self.number()?;
        if number.is_finite() {
            return Ok(number);
        }
        Err(Error::format(format!("the snapshot has {number} in a state; create the snapshot again")))
    }

    /// Returns the next word as a count of at most `limit`.
    ///
    /// # Errors
    /// Returns `Format` at the end and above the limit.
    pub fn count(&mut self, limit: usize) -> Result<usize> {
        let word = self.word()?;
        usize::try_from(word).ok().filter(|count| *count <= limit).ok_or_else(|| {
            Error::format(format!(
                "the snapshot has {word} where at most {limit} is allowed; create the snapshot again"
            ))
        })
    }

    /// Returns the next word as a boolean.
    ///
    /// # Errors
    /// Returns `Format` at the end and for words other than 0 and 1.
    pub fn flag(&mut self) -> Result<bool> {
        self.count(1).map(|word| word == 1)
    }

    /// Checks that all words were read.
    ///
    /// # Errors
    /// Returns `Format` if words are left.
    pub fn finish(self) -> Result<()> {
        match self.words.len() {
            0 => Ok(()),
            left => Err(Error::format(format!(
                "the snapshot has {left} words too many; restore it with the same wrappers"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_in_order_and_only_for_their_environment() {
        let mut snapshot = Snapshot::new("CartPole-v1");
        snapshot.push_number(0.1);
        snapshot.push(1);
        snapshot.push(7);
        assert!(snapshot.read("Pendulum-v1").is_err());
        let mut state = snapshot.read("CartPole-v1").unwrap();
        assert_eq!(state.finite().unwrap(), 0.1);
        assert!(state.flag().unwrap());
        assert!(state.count(6).is_err());
        assert!(state.word().is_err());
        assert!(snapshot.read("CartPole-v1").unwrap().finish().is_err());
    }
}
