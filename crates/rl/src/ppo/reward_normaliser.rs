//! Normalisation of rewards.

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};
use opendr_simulation::wrappers::RunningMoments;

use crate::policy::EPSILON;

/// Divides rewards by the standard deviation of the discounted return, as Stable-Baselines3's `VecNormalize` does.
#[derive(Debug, Clone)]
pub(crate) struct RewardNormaliser {
    moments: RunningMoments,
    /// Discounted return of the running episode of each environment.
    discounted: Vec<f64>,
    gamma: f64,
    clip: f64,
}

impl RewardNormaliser {
    pub fn new(environments: usize, gamma: f32, clip: f32) -> Self {
        Self {
            moments: RunningMoments::new(1),
            discounted: vec![0.0; environments],
            gamma: gamma.into(),
            clip: clip.into(),
        }
    }

    /// Writes the normalised rewards of a step of all environments; `ends` marks those where an episode ended.
    pub fn normalise(&mut self, rewards: &[f64], ends: &[bool], normalised: &mut [f32]) {
        for (discounted, reward) in self.discounted.iter_mut().zip(rewards) {
            *discounted = *discounted * self.gamma + reward;
            self.moments.add([*discounted]);
        }
        let deviation = (self.moments.variance()[0] + EPSILON).sqrt();
        for (normalised, reward) in normalised.iter_mut().zip(rewards) {
            *normalised = (reward / deviation).clamp(-self.clip, self.clip) as f32;
        }
        for (discounted, _) in self.discounted.iter_mut().zip(ends).filter(|(_, end)| **end) {
            *discounted = 0.0;
        }
    }

    pub fn save(&self, words: &mut Snapshot) {
        self.moments.save(words);
        words.extend_numbers(self.discounted.iter().copied());
    }

    pub fn load(&mut self, words: &mut StateReader<'_>) -> Result<()> {
        self.moments.load(words)?;
        self.discounted.iter_mut().try_for_each(|discounted| {
            *discounted = words.finite()?;
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn returns_have_a_deviation_of_one() {
        let mut normaliser = RewardNormaliser::new(2, 0.0, 10.0);
        let mut normalised = [0.0; 2];
        for step in 0..1000 {
            let rewards = [f64::from(step % 2) * 8.0, f64::from((step + 1) % 2) * 8.0];
            normaliser.normalise(&rewards, &[false; 2], &mut normalised);
        }
        assert!((normalised[0] - 2.0).abs() < 1e-3 && normalised[1] == 0.0, "{normalised:?}");
        normaliser.normalise(&[1e6, 0.0], &[true, false], &mut normalised);
        assert!(normalised[0] <= 10.0 && normaliser.discounted == [0.0, 0.0]);
    }
}
