//! The environment in which PPO trains a camera policy.

use opendr_engine::environment::{Environment, EnvironmentSpec, Info, ResetOptions, Space, Step};
use opendr_engine::target::Action;
use opendr_engine::{Error, Random, Result};

use crate::best_view::BestViewEstimator;
use crate::fusion::Fusion;
use crate::observation::Observer;
use crate::scene::ActiveScene;
use crate::stop::StopRule;
use crate::view_loop::ViewLoop;

/// Cost of a motion of full deflection on all axes.
const EFFORT: f32 = 0.01;
/// Cost of each motion.
const MOTION: f32 = 0.03;

/// An environment whose reward is the rise of the probability of the true class, minus the cost of the motion. An episode
/// ends with the stop rule.
pub struct ActiveEnvironment<S> {
    spec: EnvironmentSpec,
    view_loop: ViewLoop<S>,
    stop: StopRule,
    stream: Option<[u64; 2]>,
    moves: usize,
}

impl<S: ActiveScene> ActiveEnvironment<S> {
    /// Creates an environment over a scene; `estimator` is that of the best view.
    ///
    /// # Errors
    /// Returns `InvalidParam` for a scene of fewer than two classes.
    pub fn new(
        mut scene: S,
        fusion: Fusion,
        stop: StopRule,
        estimator: Option<BestViewEstimator>,
    ) -> Result<Self> {
        let action = Space::symmetric(&vec![1.0; scene.rig().axes().len()]);
        let observation = Space::symmetric(&[f32::INFINITY; Observer::LEN]);
        let spec = EnvironmentSpec::new("ActivePerception-v1", observation, action)
            .with_reward_range(-1.0 - f64::from(EFFORT + MOTION), 1.0);
        let view_loop = ViewLoop::new(scene, fusion, stop.moves, estimator)?;
        Ok(Self { spec, view_loop, stop, stream: None, moves: 0 })
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
        self.view_loop.begin(&mut Random::from_key(stream))?;
        self.view_loop.observe(observation);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        if self.stream.is_none() {
            return Err(Error::invalid_input("the environment was never reset; call reset before step"));
        }
        let before = self.view_loop.probability();
        let achieved = self.view_loop.step(&Action::new(action)?)?;
        self.moves += 1;
        let gain = self.view_loop.probability() - before;
        let (class, confidence) = self.view_loop.belief().best();
        let success = f64::from(u8::from(class == self.view_loop.class()));
        self.view_loop.observe(observation);
        Ok(Step {
            reward: f64::from(gain - EFFORT * achieved.effort() - MOTION),
            terminated: self.stop.reason(self.moves, confidence, None).is_some(),
            truncated: false,
            info: Info::default().with("success", success),
        })
    }
}
