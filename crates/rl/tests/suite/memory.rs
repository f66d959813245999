//! Recurrent policies.

use opendr_engine::environment::{Environment, EnvironmentSpec, Info, ResetOptions, Space, Step};
use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    ActionMode, Algorithm as _, Dqn, DqnConfig, EvaluationProtocol, Policy, PolicyMemory, Ppo, PpoConfig,
    evaluate, onnx_from_policy,
};
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment as _};

/// Only the first observation is not 0; the correct binary actions in the third step are its sign and the opposite.
struct Recall {
    spec: EnvironmentSpec,
    random: Random,
    is_up: bool,
    steps: u32,
}

impl Recall {
    fn new() -> Self {
        let spec = EnvironmentSpec::new("Recall-v0", Space::symmetric(&[1.0]), Space::MultiBinary(vec![2]));
        Self { spec, random: Random::new(0), is_up: false, steps: 0 }
    }
}

impl Environment for Recall {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, _: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        if let Some(seed) = seed {
            self.random = Random::new(seed);
        }
        (self.is_up, self.steps) = (self.random.chance(0.5), 0);
        observation[0] = if self.is_up { 1.0 } else { -1.0 };
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.spec.action.check(action)?;
        self.steps += 1;
        observation[0] = 0.0;
        let terminated = self.steps == 3;
        let wanted = [f32::from(self.is_up), f32::from(!self.is_up)];
        let right = action.iter().zip(wanted).filter(|(action, wanted)| **action == *wanted).count();
        Ok(Step { reward: if terminated { right as f64 } else { 0.0 }, terminated, ..Step::default() })
    }
}

fn recalls() -> EnvironmentVector {
    let worlds = (0..8).map(|_| Box::new(Recall::new()) as Box<dyn Environment>).collect();
    EnvironmentVector::new(worlds, Autoreset::SameStep, 1).unwrap()
}

fn trained(gru_size: Option<usize>, timesteps: u64) -> Policy {
    let mut worlds = recalls();
    let mut config = PpoConfig { n_steps: 24, batch_size: 96, learning_rate: 5e-3, ..PpoConfig::default() };
    (config.network.gru_size, config.network.net_arch) = (gru_size, vec![16]);
    config.sequence_length = gru_size.map(|_| 12);
    let mut ppo = Ppo::new(&config, worlds.spec()).unwrap();
    while ppo.report().timesteps < timesteps {
        ppo.iterate(&mut worlds, timesteps).unwrap();
    }
    ppo.policy().clone()
}

/// Without memory one of two binary actions is right on average: the last observation is the same in all episodes.
#[test]
fn only_recurrent_policies_recall_the_first_observation() {
    let protocol = EvaluationProtocol { episodes: 60, ..EvaluationProtocol::default() };
    let without_memory = evaluate(&trained(None, 2000), &mut Recall::new(), &protocol).unwrap();
    assert!((without_memory.mean_return - 1.0).abs() < 0.5, "{}", without_memory.mean_return);
    let policy = trained(Some(8), 8000);
    let report = evaluate(&policy, &mut Recall::new(), &protocol).unwrap();
    assert!(report.mean_return > 1.9, "{}", report.mean_return);
    let sampled = EvaluationProtocol { deterministic: false, ..protocol };
    assert!(evaluate(&policy, &mut Recall::new(), &sampled).unwrap().mean_return > 1.4);
    assert!(Policy::from_bytes(&policy.to_bytes().unwrap()).unwrap() == policy);
    let onnx = onnx_from_policy(&policy).unwrap();
    assert!(onnx.windows(10).any(|name| name == b"next_state"));
}

/// The recurrent state of a row depends on that row only, and is reset with it.
#[test]
fn rows_have_independent_states() {
    let policy = trained(Some(8), 400);
    let compute = Compute::single();
    let states = |steps: &[&[f32]], reset: Option<usize>| {
        let (mut memory, mut actions) = (PolicyMemory::default(), vec![0.0; 2 * steps[0].len()]);
        for (step, observations) in steps.iter().enumerate() {
            if step == 1
                && let Some(row) = reset
            {
                memory.reset(row);
            }
            policy.act(&compute, observations, ActionMode::Deterministic, &mut memory, &mut actions).unwrap();
        }
        memory.states().to_vec()
    };
    let both = states(&[&[1.0, -1.0], &[0.0, 0.0]], None);
    let (first, second) = both.split_at(8);
    assert!(first != second);
    assert_eq!(first, states(&[&[1.0], &[0.0]], None));
    let after_reset = states(&[&[1.0, -1.0], &[0.0, 0.0]], Some(1));
    assert_eq!((&after_reset[..8], &after_reset[8..]), (first, &states(&[&[0.0]], None)[..]));
}

#[test]
fn methods_of_single_steps_refuse_recurrent_units() {
    let spec = EnvironmentSpec::new("choice", Space::symmetric(&[1.0]), Space::discrete(2));
    let mut config = DqnConfig::default();
    config.network.gru_size = Some(8);
    let error = Dqn::new(&config, &spec).map(drop).unwrap_err().to_string();
    assert!(error.contains("gru_size = 8"), "{error}");
    let config =
        PpoConfig { sequence_length: Some(7), n_steps: 20, network: config.network, ..PpoConfig::default() };
    let error = Ppo::new(&config, &spec).map(drop).unwrap_err().to_string();
    assert!(error.contains("does not divide"), "{error}");
}
