//! The saved state of a training, from which it resumes bit for bit.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, ErrorKind, JsonFormat, Random, Result, ResultExt as _};
use opendr_kernels::Adam;
use serde::{Deserialize, Serialize};

/// State of a training: words, arrays of numbers, and the states of environments.
#[derive(Debug, Clone, PartialEq)]
pub struct SavedState {
    pub(crate) words: Snapshot,
    arrays: Vec<(&'static str, Vec<f32>)>,
    environments: Snapshot,
}

/// The JSON part of a state. Numbers are stored as words, which keep every bit.
#[derive(Serialize, Deserialize)]
struct Record {
    words: Snapshot,
    environments: Snapshot,
}

/// Array of the steps of a replay buffer in which a shield replaced the action.
pub(crate) const SHIELDED: &str = "replay_shielded";
/// Arrays that version 0.1.0 does not write.
const ADDED: [&str; 1] = [SHIELDED];
const STATE: &str = "state.json";
const FORMAT: JsonFormat = JsonFormat::new("state of a policy's training", 1);

impl SavedState {
    /// Creates an empty state of the algorithm `name` with the states of its environments.
    pub(crate) fn new(name: &str, environments: Snapshot) -> Self {
        Self { words: Snapshot::new(name), arrays: Vec::new(), environments }
    }

    /// Returns the states of the environments.
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

    /// Copies the array `name` into `numbers`, of the same length.
    pub(crate) fn fill(&self, name: &str, numbers: &mut [f32]) -> Result<()> {
        let array = self.arrays.iter().find(|(own, _)| *own == name).map_or(&[][..], |(_, row)| row);
        if array.len() != numbers.len() {
            return Err(Error::invalid_input(format!(
                "the checkpoint has {} numbers in {name}, this algorithm {}; create it with the same parameters",
                array.len(),
                numbers.len()
            )));
        }
        numbers.copy_from_slice(array);
        Ok(())
    }

    /// Copies the array `name` as [`Self::fill`] does; zeros where an older version wrote the checkpoint, without that array.
    pub(crate) fn fill_or_zero(&self, name: &str, numbers: &mut [f32]) -> Result<()> {
        if self.arrays.iter().any(|(own, _)| *own == name) {
            return self.fill(name, numbers);
        }
        numbers.fill(0.0);
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

    /// Returns the names and bytes of the files of the state: JSON, and little-endian `f32` for each array.
    ///
    /// # Errors
    /// `Internal` when the words cannot be written as JSON.
    pub fn files(&self) -> Result<Vec<(String, Vec<u8>)>> {
        let record = Record { words: self.words.clone(), environments: self.environments.clone() };
        let json = FORMAT.to_json(&record)?.into_bytes();
        let rows = self.arrays.iter().map(|(name, row)| {
            let bytes = row.iter().flat_map(|number| number.to_le_bytes());
            (file_name(name), bytes.collect())
        });
        Ok(std::iter::once((STATE.to_owned(), json)).chain(rows).collect())
    }

    /// Reads the state from the files of [`Self::files`], with the arrays `names`; `read` returns the bytes of a file. An array that
    /// older versions do not write may be absent.
    ///
    /// # Errors
    /// `Format` for a damaged file, and the errors of `read`.
    pub fn from_files(read: &dyn Fn(&str) -> Result<Vec<u8>>, names: &[&'static str]) -> Result<Self> {
        let Record { words, environments } = FORMAT.read(&read(STATE)?).context(|| STATE.to_owned())?;
        let array = |name: &&'static str| -> Result<_> {
            let bytes = match read(&file_name(name)) {
                Err(error) if ADDED.contains(name) && error.kind() == ErrorKind::NotFound => return Ok(None),
                bytes => bytes?,
            };
            let (numbers, rest) = bytes.as_chunks::<4>();
            match rest {
                [] => Ok(Some((*name, numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()))),
                _ => Err(Error::format(format!("the size of array {name} is not a multiple of 4 bytes"))),
            }
        };
        let arrays = names.iter().filter_map(|name| array(name).transpose()).collect::<Result<_>>()?;
        Ok(Self { words, arrays, environments })
    }
}

fn file_name(name: &str) -> String {
    format!("{name}.f32")
}

pub(crate) fn push_random(words: &mut Snapshot, random: &Random) {
    random.state().into_iter().for_each(|word| words.push(word));
}

pub(crate) fn read_random(words: &mut StateReader<'_>) -> Result<Random> {
    Random::from_state([words.word()?, words.word()?, words.word()?, words.word()?])
}
