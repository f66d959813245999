//! Minibatches of windows of demonstrations.

use opendr_engine::Random;

use crate::affine::Affine;
use crate::demonstrations::DemonstrationSet;

/// The part of an episode around a step that a network trains on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    /// Observations up to the current one.
    pub history: usize,
    /// Actions of the chunk.
    pub chunk: usize,
    /// Actions of the chunk that lie before the current step.
    pub past: usize,
}

/// Windows of a minibatch. Beyond the ends of an episode, the first or last row is repeated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Batch {
    /// `[batch, history, observation]`, scaled.
    pub observations: Vec<f32>,
    /// `[batch, chunk, action]`, scaled.
    pub actions: Vec<f32>,
    /// Actions of each chunk that lie within the episode, from its first.
    pub valid: Vec<usize>,
}

/// Scaled demonstrations.
#[derive(Debug, Clone)]
pub(crate) struct ScaledSet {
    observations: Vec<f32>,
    actions: Vec<f32>,
    lengths: [usize; 2],
    /// Episode's first step and number of steps, for each step.
    episodes: Vec<[usize; 2]>,
}

impl ScaledSet {
    pub fn new(set: &DemonstrationSet, observation: &Affine, action: &Affine) -> Self {
        let [observation_len, action_len] = set.row_lengths();
        let steps = set.steps();
        let mut scaled = Self {
            observations: vec![0.0; steps * observation_len],
            actions: vec![0.0; steps * action_len],
            lengths: [observation_len, action_len],
            episodes: Vec::with_capacity(steps),
        };
        for (index, episode) in set.episodes().iter().enumerate() {
            let (first, count) = (scaled.episodes.len(), set.steps_of(index));
            observation.forward(&episode.observations, &mut scaled.observations[first * observation_len..]);
            action.forward(&episode.actions, &mut scaled.actions[first * action_len..]);
            scaled.episodes.resize(first + count, [first, count]);
        }
        scaled
    }

    /// Draws `count` windows.
    pub fn draw(&self, window: Window, count: usize, random: &mut Random, batch: &mut Batch) {
        batch.observations.clear();
        batch.actions.clear();
        batch.valid.clear();
        for _ in 0..count {
            self.add(window, random.below(self.episodes.len()), batch);
        }
    }

    /// Adds the window around a step.
    fn add(&self, window: Window, step: usize, batch: &mut Batch) {
        let [first, count] = self.episodes[step];
        let last = first + count - 1;
        let [observation_len, action_len] = self.lengths;
        for back in (0..window.history).rev() {
            let at = step.saturating_sub(back).max(first);
            batch
                .observations
                .extend_from_slice(&self.observations[at * observation_len..][..observation_len]);
        }
        for ahead in 0..window.chunk {
            let at = (step + ahead).saturating_sub(window.past).clamp(first, last);
            batch.actions.extend_from_slice(&self.actions[at * action_len..][..action_len]);
        }
        batch.valid.push((last + 1 - step + window.past).min(window.chunk));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demonstrations::Episode;

    #[test]
    fn windows_repeat_the_ends_of_their_episode() {
        let mut set = DemonstrationSet::new([1, 1]).unwrap();
        for start in [10.0f32, 20.0] {
            let observations: Vec<f32> = (0..3).map(|step| start + step as f32).collect();
            let actions = observations.iter().map(|x| -x).collect();
            set.add(Episode { observations, actions }).unwrap();
        }
        let unit = Affine::unit_range(&[-1.0, 1.0], 1);
        let scaled = ScaledSet::new(&set, &unit, &unit);
        let mut batch = Batch::default();
        let window = Window { history: 2, chunk: 4, past: 1 };
        scaled.add(window, 3, &mut batch);
        assert_eq!(batch.observations, [20.0, 20.0]);
        assert_eq!(batch.actions, [-20.0, -20.0, -21.0, -22.0]);
        scaled.add(window, 2, &mut batch);
        assert_eq!(batch.observations[2..], [11.0, 12.0]);
        assert_eq!(batch.actions[4..], [-11.0, -12.0, -12.0, -12.0]);
        assert_eq!(batch.valid, [4, 2]);
    }
}
