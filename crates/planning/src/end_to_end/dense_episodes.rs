//! A wrapper that increases the number of obstacles in every second episode.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};

/// A corridor environment with 8 to 10 obstacles in every second episode, regardless of its options. Policies trained in
/// it also pass narrow gaps.
#[derive(Debug, Clone)]
pub struct DenseObstacles<E> {
    inner: E,
    episodes: u64,
}

/// Reset options of the episodes with more obstacles.
const DENSE: [(&str, i64); 2] = [("min_obstacles", 8), ("max_obstacles", 10)];

/// Returns the reset options of an episode with more obstacles.
pub(super) fn dense_options() -> ResetOptions {
    DENSE.map(|(name, value)| (name.to_owned(), value.into())).into_iter().collect()
}

impl<E: Environment> DenseObstacles<E> {
    /// Wraps a corridor environment.
    pub fn new(inner: E) -> Self {
        Self { inner, episodes: 0 }
    }
}

impl<E: Environment> Environment for DenseObstacles<E> {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.episodes += 1;
        if self.episodes.is_multiple_of(2) {
            let mut options = options.clone();
            options.extend(dense_options());
            return self.inner.reset(seed, &options, observation);
        }
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.inner.step(action, observation)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push(self.episodes);
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.episodes = state.word()?;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}
