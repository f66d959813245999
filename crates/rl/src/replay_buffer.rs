//! Replay buffer of off-policy methods.

use opendr_engine::environment::StateReader;
use opendr_engine::{Error, Random, Result};

use crate::policy::ObservationEncoder;
use crate::saved_state::{SHIELDED, SavedState};

/// Ring buffer of past steps; the oldest are overwritten. Observations are stored as the environment returns them.
#[derive(Debug, Clone)]
pub(crate) struct ReplayBuffer {
    capacity: usize,
    len: usize,
    next: usize,
    widths: [usize; 2],
    observations: Vec<f32>,
    next_observations: Vec<f32>,
    actions: Vec<f32>,
    rewards: Vec<f32>,
    /// 0 for a terminal step, else 1.
    continues: Vec<f32>,
    /// 1 for a step in which a shield replaced the action, else 0.
    shielded: Vec<f32>,
}

/// A batch of sampled steps; its memory is reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Transitions {
    /// Inputs of the networks, once [encoded](Self::encode).
    pub observations: Vec<f32>,
    pub next_observations: Vec<f32>,
    raw: [Vec<f32>; 2],
    pub actions: Vec<f32>,
    pub rewards: Vec<f32>,
    pub continues: Vec<f32>,
}

/// One step of one environment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transition<'a> {
    pub observation: &'a [f32],
    pub action: &'a [f32],
    pub reward: f32,
    pub next_observation: &'a [f32],
    pub terminated: bool,
    /// Whether a shield replaced the action; `action` is the executed one.
    pub shielded: bool,
}

/// Maximum numbers in a buffer: 8 GiB.
const MAX_NUMBERS: usize = 1 << 31;

/// Names of the arrays of a saved buffer.
pub(crate) const ROWS: [&str; 6] = [
    "replay_observations",
    "replay_next_observations",
    "replay_actions",
    "replay_rewards",
    "replay_continues",
    SHIELDED,
];

impl ReplayBuffer {
    /// Allocates room for `capacity` steps, each with `observation` and `action` numbers.
    pub fn new(capacity: usize, observation: usize, action: usize) -> Result<Self> {
        let numbers = (2 * observation + action + 2).checked_mul(capacity);
        if capacity == 0 || numbers.is_none_or(|numbers| numbers > MAX_NUMBERS) {
            return Err(Error::invalid_param(format!(
                "buffer_size = {capacity} steps of {observation} + {action} numbers; set at least 1 step and at most {MAX_NUMBERS} numbers"
            )));
        }
        let zeros = |width: usize| vec![0.0; capacity * width];
        Ok(Self {
            capacity,
            len: 0,
            next: 0,
            widths: [observation, action],
            observations: zeros(observation),
            next_observations: zeros(observation),
            actions: zeros(action),
            rewards: zeros(1),
            continues: zeros(1),
            shielded: zeros(1),
        })
    }

    pub fn len(&self) -> usize {
        self.len
    }

    pub fn add(&mut self, step: Transition<'_>) {
        let ([observation, action], at) = (self.widths, self.next);
        self.observations[at * observation..(at + 1) * observation].copy_from_slice(step.observation);
        self.next_observations[at * observation..(at + 1) * observation]
            .copy_from_slice(step.next_observation);
        self.actions[at * action..(at + 1) * action].copy_from_slice(step.action);
        self.rewards[at] = step.reward;
        self.continues[at] = f32::from(!step.terminated);
        self.shielded[at] = f32::from(step.shielded);
        self.next = (at + 1) % self.capacity;
        self.len = self.capacity.min(self.len + 1);
    }

    /// Samples `count` steps uniformly, with replacement, into `batch`.
    pub fn sample(&self, count: usize, random: &mut Random, batch: &mut Transitions) {
        batch.clear();
        self.append(count, random, batch);
    }

    /// Samples `count` steps as [`sample`](Self::sample) does, behind those of `batch`.
    pub fn append(&self, count: usize, random: &mut Random, batch: &mut Transitions) {
        let [observation, action] = self.widths;
        for _ in 0..count {
            let at = random.below(self.len);
            let row = at * observation..(at + 1) * observation;
            batch.raw[0].extend_from_slice(&self.observations[row.clone()]);
            batch.raw[1].extend_from_slice(&self.next_observations[row]);
            batch.actions.extend_from_slice(&self.actions[at * action..(at + 1) * action]);
            batch.rewards.push(self.rewards[at]);
            batch.continues.push(self.continues[at]);
        }
    }

    pub fn save(&self, state: &mut SavedState) {
        let ([observation, action], len) = (self.widths, self.len);
        state.words.push(len as u64);
        state.words.push(self.next as u64);
        state.add(ROWS[0], &self.observations[..len * observation]);
        state.add(ROWS[1], &self.next_observations[..len * observation]);
        state.add(ROWS[2], &self.actions[..len * action]);
        state.add(ROWS[3], &self.rewards[..len]);
        state.add(ROWS[4], &self.continues[..len]);
        state.add(ROWS[5], &self.shielded[..len]);
    }

    pub fn load(&mut self, state: &SavedState, words: &mut StateReader<'_>) -> Result<()> {
        let ([observation, action], len) = (self.widths, words.count(self.capacity)?);
        self.next = words.count(self.capacity - 1)?;
        self.len = len;
        state.fill(ROWS[0], &mut self.observations[..len * observation])?;
        state.fill(ROWS[1], &mut self.next_observations[..len * observation])?;
        state.fill(ROWS[2], &mut self.actions[..len * action])?;
        state.fill(ROWS[3], &mut self.rewards[..len])?;
        state.fill(ROWS[4], &mut self.continues[..len])?;
        state.fill_or_zero(ROWS[5], &mut self.shielded[..len])
    }
}

impl Transitions {
    /// Encodes the sampled observations with the current moments of the normaliser.
    pub fn encode(&mut self, encoder: &ObservationEncoder) -> Result<()> {
        let Self { observations, next_observations, raw, rewards, .. } = self;
        for (raw, encoded) in raw.iter().zip([observations, next_observations]) {
            encoded.resize(rewards.len() * encoder.encoded_len(), 0.0);
            encoder.encode(raw, encoded)?;
        }
        Ok(())
    }

    /// Writes the targets of the values: reward plus discounted value of the next step, which counts 0 after a terminal step.
    pub fn bellman_targets(
        &self,
        gamma: f32,
        next_values: impl Iterator<Item = f32>,
        targets: &mut Vec<f32>,
    ) {
        let steps = self.rewards.iter().zip(&self.continues);
        targets.clear();
        targets.extend(
            steps.zip(next_values).map(|((reward, continues), value)| reward + continues * gamma * value),
        );
    }

    fn clear(&mut self) {
        self.rows().into_iter().for_each(Vec::clear);
    }

    fn rows(&mut self) -> [&mut Vec<f32>; 5] {
        let Self { raw: [observations, next_observations], actions, rewards, continues, .. } = self;
        [observations, next_observations, actions, rewards, continues]
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::Snapshot;

    use super::*;

    fn filled(steps: usize) -> ReplayBuffer {
        let mut buffer = ReplayBuffer::new(5, 2, 1).unwrap();
        for step in 0..steps {
            let number = step as f32;
            buffer.add(Transition {
                observation: &[number, -number],
                action: &[10.0 * number],
                reward: 100.0 * number,
                next_observation: &[number + 1.0, 0.0],
                terminated: step % 2 == 0,
                shielded: false,
            });
        }
        buffer
    }

    #[test]
    fn samples_are_whole_steps_among_the_newest() {
        let (buffer, mut random, mut batch) = (filled(7), Random::new(1), Transitions::default());
        buffer.sample(500, &mut random, &mut batch);
        let mut counts = [0; 7];
        for at in 0..500 {
            let number = batch.raw[0][2 * at];
            counts[number as usize] += 1;
            assert_eq!(batch.raw[1][2 * at], number + 1.0);
            assert_eq!((batch.actions[at], batch.rewards[at]), (10.0 * number, 100.0 * number));
            assert_eq!(batch.continues[at], number % 2.0);
        }
        assert!(counts[..2] == [0, 0] && counts[2..].iter().all(|count| *count > 60), "{counts:?}");
    }

    #[test]
    fn is_restored_from_a_saved_state() {
        let buffer = filled(3);
        let mut state = SavedState::new("test", Snapshot::new("none"));
        buffer.save(&mut state);
        let mut other = ReplayBuffer::new(5, 2, 1).unwrap();
        other.load(&state, &mut state.words.read("test").unwrap()).unwrap();
        assert_eq!((other.len, other.next, &other.actions), (3, 3, &buffer.actions));
        let mut small = ReplayBuffer::new(2, 2, 1).unwrap();
        assert!(small.load(&state, &mut state.words.read("test").unwrap()).is_err());
        assert!(ReplayBuffer::new(1 << 40, 2, 1).is_err());
    }
}
