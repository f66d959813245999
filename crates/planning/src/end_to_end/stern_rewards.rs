//! Rewards that make it worth while to arrive.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};

/// A corridor as policies are trained in it: with OpenDR's rewards, to leave the track or to collide (-10, -20) is cheaper than
/// to squeeze between two obstacles (-12 a step). Here every end that is no success earns -60, and no step on the way
/// costs anything: to come near an obstacle is not wrong, and a policy that learnt that it is gave up gaps that it could pass.
#[derive(Debug, Clone)]
pub struct SternRewards<E>(pub E);

const FAILURE: f64 = -60.0;

impl<E: Environment> Environment for SternRewards<E> {
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
