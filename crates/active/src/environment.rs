//! Where PPO trains a policy of movement.

use opendr_engine::environment::{Environment, EnvironmentSpec, Info, ResetOptions, Space, Step};
use opendr_engine::target::Action;
use opendr_engine::{Error, Random, Result};

use crate::fusion::Fusion;
use crate::look::Look;
use crate::observation::Observer;
use crate::scene::ActiveScene;
use crate::stop::StopRule;

/// What a movement of full deflection on all axes costs.
const EFFORT: f32 = 0.01;
/// What each movement costs, so that fewer are better.
const MOVEMENT: f32 = 0.01;

/// An environment whose reward is by how much the probability of the true class rose, less the cost of the movement. An
/// episode ends with the stop rule.
pub struct ActiveEnvironment<S> {
    spec: EnvironmentSpec,
    look: Look<S>,
    stop: StopRule,
    stream: Option<[u64; 2]>,
    moves: usize,
}

impl<S: ActiveScene> ActiveEnvironment<S> {
    /// An environment over a scene.
    ///
    /// # Errors
    /// `InvalidParam` for a scene of fewer than two classes.
    pub fn new(mut scene: S, fusion: Fusion, stop: StopRule) -> Result<Self> {
        let action = Space::symmetric(&vec![1.0; scene.rig().axes().len()]);
        let observation = Space::symmetric(&[f32::INFINITY; Observer::LEN]);
        let spec = EnvironmentSpec::new("ActivePerception-v1", observation, action)
            .with_reward_range(-1.0 - f64::from(EFFORT + MOVEMENT), 1.0);
        Ok(Self { spec, look: Look::new(scene, fusion, stop.moves)?, stop, stream: None, moves: 0 })
    }
}

impl<S: ActiveScene> Environment for ActiveEnvironment<S> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, _: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let stream = match (seed, self.stream) {
            (Some(seed), _) => [seed, 0],
            (None, Some([seed, episode])) => [seed, episode + 1],
            (None, None) => return Err(Error::invalid_input("the first episode needs a seed")),
        };
        self.stream = Some(stream);
        self.moves = 0;
        self.look.begin(&mut Random::from_key(stream))?;
        self.look.observe(observation);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        if self.stream.is_none() {
            return Err(Error::invalid_input("the environment was never reset; call reset before step"));
        }
        let before = self.look.probability();
        let achieved = self.look.step(&Action::new(action)?)?;
        self.moves += 1;
        let gain = self.look.probability() - before;
        let (class, confidence) = self.look.belief().best();
        let success = f64::from(u8::from(class == self.look.class()));
        self.look.observe(observation);
        Ok(Step {
            reward: f64::from(gain - EFFORT * achieved.effort() - MOVEMENT),
            terminated: self.stop.reason(self.moves, confidence, None).is_some(),
            truncated: false,
            info: Info::default().with("success", success),
        })
    }
}
