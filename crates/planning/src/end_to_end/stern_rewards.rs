//! A wrapper with rewards that favour arrival.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};

/// A corridor environment with the rewards of the training.
///
/// With OpenDR's rewards, leaving the track or a collision (-10, -20) costs less than passing between two obstacles (-12
/// per step). Here every end without success has a reward of -60, and steps have no negative reward: proximity to an
/// obstacle is not penalised, because policies trained with the penalty did not pass gaps of sufficient width.
#[derive(Debug, Clone)]
pub struct TrainingRewards<E>(pub E);

const FAILURE: f64 = -60.0;

impl<E: Environment> Environment for TrainingRewards<E> {
    fn spec(&self) -> &EnvironmentSpec {
        self.0.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.0.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let step = self.0.step(action, observation)?;
        let has_failed = step.terminated && step.info.get("success") != Some(1.0);
        let reward = match has_failed {
            true => FAILURE,
            false => step.reward.max(0.0),
        };
        Ok(Step { reward, ..step })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.0.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.0.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.0.render()
    }
}
