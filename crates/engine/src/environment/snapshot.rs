//! States of environments, to come back to.

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// A state of an environment, written as words: numbers keep every bit through any file format.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Snapshot {
    id: String,
    words: Vec<u64>,
}

impl Snapshot {
    /// A snapshot of the environment called `id`, still without words.
    pub fn new(id: &str) -> Self {
        Self { id: id.to_owned(), words: Vec::new() }
    }

    /// The environment that it belongs to.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Writes a word.
    pub fn push(&mut self, word: u64) {
        self.words.push(word);
    }

    /// Writes a number.
    pub fn push_number(&mut self, number: f64) {
        self.words.push(number.to_bits());
    }

    /// Writes several numbers.
    pub fn extend_numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.words.extend(numbers.into_iter().map(f64::to_bits));
    }

    /// Begins to read it as a state of the environment called `id`.
    ///
    /// # Errors
    /// `InvalidInput` when it belongs to another environment.
    pub fn read(&self, id: &str) -> Result<StateReader<'_>> {
        if self.id != id {
            let own = &self.id;
            return Err(Error::invalid_input(format!(
                "a snapshot of {own} cannot be restored in {id}; make {own:?} and restore it there"
            )));
        }
        Ok(StateReader { words: &self.words })
    }
}

/// Reads what lies in a [`Snapshot`], in the order in which it was written.
#[derive(Debug)]
pub struct StateReader<'a> {
    words: &'a [u64],
}

impl StateReader<'_> {
    /// The next word.
    ///
    /// # Errors
    /// `Format` at the end.
    pub fn word(&mut self) -> Result<u64> {
        let (word, rest) = self.words.split_first().ok_or_else(|| {
            Error::format("the snapshot ends too early; take it again with this version of the environment")
        })?;
        self.words = rest;
        Ok(*word)
    }

    /// The next number.
    ///
    /// # Errors
    /// `Format` at the end.
    pub fn number(&mut self) -> Result<f64> {
        self.word().map(f64::from_bits)
    }

    /// The next number, which is finite: a state that is not would spoil an episode without a word.
    ///
    /// # Errors
    /// `Format` at the end and for NaN and infinities.
    pub fn finite(&mut self) -> Result<f64> {
        let number = self.number()?;
        if number.is_finite() {
            return Ok(number);
        }
        Err(Error::format(format!("the snapshot has {number} in a state; take it again")))
    }

    /// A count of things that follow, at most `limit`.
    ///
    /// # Errors
    /// `Format` at the end and above the limit.
    pub fn count(&mut self, limit: usize) -> Result<usize> {
        let word = self.word()?;
        usize::try_from(word).ok().filter(|count| *count <= limit).ok_or_else(|| {
            Error::format(format!("the snapshot has {word} where at most {limit} can be; take it again"))
        })
    }

    /// The next word as yes or no.
    ///
    /// # Errors
    /// `Format` at the end and for other words.
    pub fn flag(&mut self) -> Result<bool> {
        self.count(1).map(|word| word == 1)
    }

    /// Ends reading.
    ///
    /// # Errors
    /// `Format` when words are left.
    pub fn finish(self) -> Result<()> {
        match self.words.len() {
            0 => Ok(()),
            left => Err(Error::format(format!(
                "the snapshot has {left} words too many; restore it behind the same wrappers"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_come_back_in_order_and_only_for_their_environment() {
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
