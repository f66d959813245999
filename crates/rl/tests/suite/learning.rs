//! Trained policies and values are correct.

use opendr_engine::environment::{Environment, EnvironmentSpec, Info, ResetOptions, Space, Step};
use opendr_engine::{ErrorKind, Result};
use opendr_rl::{Algorithm as _, EvaluationProtocol, Ppo, PpoConfig, evaluate};
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment, VectorOptions};
use opendr_simulation::wrappers::TimeLimit;
use opendr_simulation::{make, make_vec};

/// Two alternating states; only the first one gives `reward`. The observation of step `broken` is NaN.
struct Chain {
    spec: EnvironmentSpec,
    state: bool,
    steps: u32,
    broken: u32,
    reward: f64,
}

impl Chain {
    fn new(broken: u32, reward: f64) -> Self {
        let spec = EnvironmentSpec::new("Chain-v0", Space::symmetric(&[1.0, 1.0]), Space::discrete(2));
        Self { spec, state: false, steps: 0, broken, reward }
    }

    fn observe(&self, observation: &mut [f32]) {
        observation.copy_from_slice(&[f32::from(self.state), f32::from(!self.state)]);
        if self.steps == self.broken {
            observation[1] = f32::NAN;
        }
    }
}

impl Environment for Chain {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, _: Option<u64>, _: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.state = false;
        self.observe(observation);
        Ok(Info::default())
    }

    fn step(&mut self, _: &[f32], observation: &mut [f32]) -> Result<Step> {
        let reward = if self.state { 0.0 } else { self.reward };
        self.state = !self.state;
        self.steps += 1;
        self.observe(observation);
        Ok(Step { reward, ..Step::default() })
    }
}

fn chains(broken: u32, reward: f64) -> EnvironmentVector {
    let chain = || Box::new(TimeLimit::new(Chain::new(broken, reward), 5).unwrap()) as Box<dyn Environment>;
    EnvironmentVector::new((0..4).map(|_| chain()).collect(), Autoreset::SameStep, 1).unwrap()
}

/// With a discount of 0.9 the first state has the value 1 / (1 - 0.81), the second 0.9 times that. If truncated episodes of
/// five steps counted as terminated, both values would be below 3.
#[test]
fn truncation_does_not_reduce_values() {
    let mut worlds = chains(u32::MAX, 1.0);
    let config = PpoConfig {
        gamma: 0.9,
        n_steps: 32,
        learning_rate: 3e-3,
        learning_rate_schedule: opendr_rl::Schedule::Linear,
        ..PpoConfig::default()
    };
    let mut ppo = Ppo::new(&config, worlds.spec()).unwrap();
    while ppo.report().timesteps < 20_000 {
        ppo.iterate(&mut worlds, 20_000).unwrap();
    }
    let values = ppo.predict_values(&[0.0, 1.0, 1.0, 0.0]).unwrap();
    let first = 1.0 / (1.0 - 0.81);
    for (value, expected) in values.iter().zip([first, 0.9 * first]) {
        assert!((value / expected - 1.0).abs() < 0.02, "{values:?}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_reported_with_their_step() {
    let mut worlds = chains(21, 1.0);
    let mut ppo = Ppo::new(&PpoConfig { n_steps: 8, ..PpoConfig::default() }, worlds.spec()).unwrap();
    let error = (0..9).find_map(|_| ppo.iterate(&mut worlds, 1000).err()).unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    let text = error.to_string();
    assert!(text.starts_with("at time step 84: number 1 of observation 0 is NaN"), "{text}");

    let mut worlds = chains(u32::MAX, 1e30);
    let mut ppo = Ppo::new(&PpoConfig { n_steps: 8, ..PpoConfig::default() }, worlds.spec()).unwrap();
    let before = ppo.policy().parameters().to_vec();
    let error = ppo.iterate(&mut worlds, 1000).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Internal);
    assert!(error.to_string().starts_with("the loss of values is inf at time step 32"), "{error}");
    assert_eq!(ppo.policy().parameters(), before);
}

fn carts(count: usize) -> Box<dyn VecEnvironment> {
    let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(count) };
    make_vec("CartPole-v1", options).unwrap()
}

#[test]
fn ppo_learns_to_balance_the_pole() {
    let preset = PpoConfig::preset("CartPole-v1").unwrap();
    let mut carts = carts(preset.environments);
    let mut ppo = Ppo::new(&preset.config, carts.spec()).unwrap();
    while ppo.report().timesteps < 30_000 {
        ppo.iterate(&mut *carts, preset.timesteps).unwrap();
    }
    let mut cart = make("CartPole-v1").unwrap();
    let protocol = EvaluationProtocol { episodes: 20, ..EvaluationProtocol::default() };
    let report = evaluate(ppo.policy(), &mut *cart, &protocol).unwrap();
    assert!(report.mean_return > 200.0, "{}", report.mean_return);
    assert!(evaluate(ppo.policy(), &mut *make("Pendulum-v1").unwrap(), &protocol).is_err());
}

#[test]
fn environments_must_report_how_episodes_end() {
    let mut carts = make_vec("CartPole-v1", VectorOptions::new(2)).unwrap();
    let mut ppo = Ppo::new(&PpoConfig::default(), carts.spec()).unwrap();
    let error = ppo.iterate(&mut *carts, 1000).unwrap_err();
    assert!(error.to_string().contains("Autoreset::SameStep"), "{error}");
    let mut pendulums = make_vec("Pendulum-v1", VectorOptions::new(2)).unwrap();
    assert!(ppo.iterate(&mut *pendulums, 1000).is_err());
}
