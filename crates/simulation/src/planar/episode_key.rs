//! Which episode of a random stream is played.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Random, Result};

use crate::NumpyRandom;

/// A random stream and the number of an episode in it: all random numbers of the episode follow from both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct EpisodeKey {
    stream: u64,
    episode: u64,
}

impl EpisodeKey {
    /// Returns the key after a reset: the first of the stream of a seed, else the next one, else one from entropy.
    pub fn after_reset(seed: Option<u64>, last: Option<Self>) -> Self {
        match (seed, last) {
            (None, Some(last)) => Self { episode: last.episode.wrapping_add(1), ..last },
            (seed, _) => {
                Self { stream: seed.unwrap_or_else(|| NumpyRandom::from_entropy().bits()), episode: 0 }
            }
        }
    }

    pub fn random(self) -> Random {
        Random::from_key([self.stream, self.episode])
    }

    pub fn save(self, snapshot: &mut Snapshot) {
        [self.stream, self.episode].into_iter().for_each(|word| snapshot.push(word));
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        Ok(Self { stream: state.word()?, episode: state.word()? })
    }
}
