//! What a learner writes to go on later, bit for bit.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Adam;
use serde::{Deserialize, Serialize};

/// Words, long rows of numbers, and the states of environments: everything that decides the future of a training.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedState {
    pub(crate) words: Snapshot,
    arrays: Vec<(&'static str, Vec<f32>)>,
    environments: Snapshot,
}

/// What of it is JSON; numbers are words there, so that they keep every bit.
#[derive(Serialize, Deserialize)]
struct Record {
    words: Snapshot,
    environments: Snapshot,
}

const STATE: &str = "state.json";

impl SavedState {
    /// Still empty, of the learner called `name` and these environments.
    pub(crate) fn new(name: &str, environments: Snapshot) -> Self {
        Self { words: Snapshot::new(name), arrays: Vec::new(), environments }
    }

    /// The states of environments.
    pub fn environments(&self) -> &Snapshot {
        &self.environments
    }

    pub(crate) fn add(&mut self, name: &'static str, numbers: &[f32]) {
        self.arrays.push((name, numbers.to_vec()));
    }

    pub(crate) fn add_adam(&mut self, names: [&'static str; 2], adam: &Adam) {
        self.words.push(adam.steps);
        self.add(names[0], &adam.first);
        self.add(names[1], &adam.second);
    }

    /// Copies the row called `name` into one of the same length.
    pub(crate) fn fill(&self, name: &str, numbers: &mut [f32]) -> Result<()> {
        let found = self.arrays.iter().find(|(own, _)| *own == name).map_or(&[][..], |(_, row)| row);
        if found.len() != numbers.len() {
            return Err(Error::invalid_input(format!(
                "the checkpoint has {} numbers in {name}, this learner {}; make it with the same parameters",
                found.len(),
                numbers.len()
            )));
        }
        numbers.copy_from_slice(found);
        Ok(())
    }

    pub(crate) fn fill_adam(
        &self,
        names: [&str; 2],
        adam: &mut Adam,
        words: &mut StateReader<'_>,
    ) -> Result<()> {
        adam.steps = words.word()?;
        self.fill(names[0], &mut adam.first)?;
        self.fill(names[1], &mut adam.second)
    }

    /// Names and bytes of the files that hold it: JSON, and little-endian numbers for each row.
    ///
    /// # Errors
    /// `Internal` where words have no JSON form.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>> {
        let record = Record { words: self.words.clone(), environments: self.environments.clone() };
        let json = serde_json::to_vec(&record)
            .map_err(|error| Error::internal("a state has no JSON form").with_source(error))?;
        let rows = self.arrays.iter().map(|(name, row)| {
            let bytes = row.iter().flat_map(|number| number.to_le_bytes());
            (file_of(name), bytes.collect())
        });
        Ok(std::iter::once((STATE.to_owned(), json)).chain(rows).collect())
    }

    /// The state in the files that [`Self::files`] gave, of a learner that has the rows called `names`; `read` gives the bytes
    /// of a file.
    ///
    /// # Errors
    /// `Format` when a file is damaged, and those of `read`.
    pub fn from_files(read: &dyn Fn(&str) -> Result<Vec<u8>>, names: &[&'static str]) -> Result<Self> {
        let Record { words, environments } = serde_json::from_slice(&read(STATE)?).map_err(|error| {
            Error::format("the state of a training is not what is wanted").with_source(error)
        })?;
        let array = |name: &&'static str| -> Result<_> {
            let bytes = read(&file_of(name))?;
            let (numbers, rest) = bytes.as_chunks::<4>();
            match rest {
                [] => Ok((*name, numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())),
                _ => Err(Error::format(format!("{name} is no row of numbers of four bytes"))),
            }
        };
        let arrays = names.iter().map(array).collect::<Result<_>>()?;
        Ok(Self { words, arrays, environments })
    }
}

fn file_of(name: &str) -> String {
    format!("{name}.f32")
}

pub(crate) fn push_random(words: &mut Snapshot, random: &Random) {
    random.state().into_iter().for_each(|word| words.push(word));
}

pub(crate) fn read_random(words: &mut StateReader<'_>) -> Result<Random> {
    Random::from_state([words.word()?, words.word()?, words.word()?, words.word()?])
}
