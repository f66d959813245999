//! Behaviour cloning: imitation learning from demonstrations.

use std::ops::ControlFlow;

use opendr_engine::environment::{Controller, Environment, EnvironmentSpec, ResetOptions};
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result, ResultExt as _};
use opendr_kernels::{Adam, AdamOptions, Compute};

use crate::algorithm::diverged;
use crate::policy::{Head, Likelihood, Policy, PolicyMemory};

/// Settings of [`clone_behaviour`]. Names and defaults are those of the `imitation` library.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct BehaviourCloningConfig {
    /// Learning rate of Adam.
    #[param(default = 1e-3, range = 0.0..=1.0, log)]
    pub learning_rate: f32,
    /// Steps per minibatch.
    #[param(default = 32, range = 1..=1_000_000, log)]
    pub batch_size: usize,
    /// Passes over all demonstrations.
    #[param(default = 10, range = 1..=1_000_000)]
    pub n_epochs: usize,
    /// Weight of the entropy in the loss.
    #[param(default = 1e-3, range = 0.0..=10.0)]
    pub ent_weight: f32,
    /// Seed of the order of steps.
    #[param(default = 0)]
    pub seed: u64,
}

/// Observations and the actions taken on them, one row per step, as the environment defines them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Demonstrations {
    observations: Vec<f32>,
    actions: Vec<f32>,
    steps: usize,
}

impl Demonstrations {
    /// Creates demonstrations for an environment with this specification, from flat rows.
    ///
    /// # Errors
    /// `InvalidInput` when the lengths do not match the spaces, or an action is not in its space.
    pub fn new(spec: &EnvironmentSpec, observations: Vec<f32>, actions: Vec<f32>) -> Result<Self> {
        let (observation_len, action_len) = (spec.observation.len().max(1), spec.action.len().max(1));
        let steps = actions.len() / action_len;
        if steps == 0 || actions.len() != steps * action_len || observations.len() != steps * observation_len
        {
            return Err(Error::invalid_input(format!(
                "{} observation numbers and {} action numbers; give the same number of rows of {observation_len} and {action_len} numbers",
                observations.len(),
                actions.len()
            )));
        }
        for (step, action) in actions.chunks_exact(action_len).enumerate() {
            spec.action.check(action).context(|| format!("the action of step {step}"))?;
        }
        Ok(Self { observations, actions, steps })
    }

    /// Records a controller in one episode per seed.
    ///
    /// # Errors
    /// The errors of the environment and of the controller.
    pub fn record(
        controller: &mut dyn Controller,
        environment: &mut dyn Environment,
        seeds: impl IntoIterator<Item = u64>,
    ) -> Result<Self> {
        let spec = environment.spec().clone();
        let mut observation = vec![0.0; spec.observation.len()];
        let mut action = vec![0.0; spec.action.len()];
        let (mut observations, mut actions) = (Vec::new(), Vec::new());
        for seed in seeds {
            environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
            controller.reset();
            loop {
                controller.act(&observation, &mut action)?;
                observations.extend_from_slice(&observation);
                actions.extend_from_slice(&action);
                if environment.step(&action, &mut observation)?.is_over() {
                    break;
                }
            }
        }
        Self::new(&spec, observations, actions)
    }

    /// Returns the number of steps.
    pub fn steps(&self) -> usize {
        self.steps
    }
}

/// Work memory of a minibatch.
#[derive(Default)]
struct Memory {
    policy: PolicyMemory,
    likelihood: Likelihood,
    observations: Vec<f32>,
    actions: Vec<f32>,
    dlogs: Vec<f32>,
    doutputs: Vec<f32>,
    gradients: Vec<f32>,
}

/// Trains a policy to imitate demonstrations (Pomerleau, 1991). The loss is the negative log-likelihood of the actions, or their
/// mean squared error for a deterministic policy. A normaliser takes its statistics from the demonstrations. `observer` receives
/// the epoch and its mean loss and may stop the training. Returns the mean losses of all epochs.
///
/// # Errors
/// `InvalidInput` when the demonstrations do not match the spaces, `Unsupported` for Q-networks and recurrent policies, `Internal`
/// when learning diverges.
pub fn clone_behaviour(
    policy: &mut Policy,
    demonstrations: &Demonstrations,
    config: &BehaviourCloningConfig,
    compute: &Compute,
    observer: &mut dyn FnMut(usize, f64) -> ControlFlow<()>,
) -> Result<Vec<f64>> {
    config.check()?;
    policy.config.check_no_memory("behaviour cloning")?;
    if let Head::Greedy { .. } = policy.head {
        return Err(Error::unsupported("behaviour cloning cannot train a Q-network; use a policy of ppo"));
    }
    let steps = demonstrations.steps;
    if demonstrations.observations.len() != steps * policy.encoder.raw_len()
        || demonstrations.actions.len() != steps * policy.head.action_len()
    {
        return Err(Error::invalid_input(format!(
            "the demonstrations do not match a policy for observations {}; record them in its environment",
            policy.observation()
        )));
    }
    policy.encoder.learn(&demonstrations.observations);
    let mut encoded = vec![0.0; steps * policy.encoder.encoded_len()];
    policy.encoder.encode(&demonstrations.observations, &mut encoded)?;
    let mut actions = vec![0.0; demonstrations.actions.len()];
    policy.head.distribution_actions(&demonstrations.actions, &mut actions);
    let mut random = Random::from_key([config.seed, 2]);
    let mut adam = Adam::new(policy.parameters.len(), AdamOptions::default());
    let mut order: Vec<_> = (0..steps).collect();
    let (mut memory, mut losses) = (Memory::default(), Vec::new());
    for epoch in 0..config.n_epochs {
        random.shuffle(&mut order);
        let mut sum = 0.0;
        for places in order.chunks(config.batch_size) {
            memory.gather(places, [&encoded, &actions], steps);
            let loss = memory.pass(policy, compute, config.ent_weight);
            if !loss.is_finite() {
                return Err(diverged("the loss of behaviour cloning", loss.into(), adam.steps));
            }
            adam.step(compute, config.learning_rate, &mut policy.parameters, &memory.gradients);
            sum += f64::from(loss) * places.len() as f64;
        }
        losses.push(sum / steps as f64);
        if observer(epoch, sum / steps as f64).is_break() {
            break;
        }
    }
    Ok(losses)
}

impl Memory {
    fn gather(&mut self, places: &[usize], [encoded, actions]: [&[f32]; 2], steps: usize) {
        for (from, to) in [(encoded, &mut self.observations), (actions, &mut self.actions)] {
            let width = from.len() / steps;
            to.clear();
            places.iter().for_each(|place| to.extend_from_slice(&from[place * width..(place + 1) * width]));
        }
    }

    /// Computes the loss and its gradients.
    fn pass(&mut self, policy: &Policy, compute: &Compute, ent_weight: f32) -> f32 {
        let outputs = policy.forward(compute, &self.observations, &mut self.policy);
        let rows = outputs.len() / policy.head.outputs();
        let scale = 1.0 / rows as f32;
        self.gradients.clear();
        self.gradients.resize(policy.parameters.len(), 0.0);
        let first = policy.parameters.len() - policy.head.parameters();
        let loss = match &policy.head {
            Head::Squashed(_) => {
                self.doutputs.clear();
                let mut loss = 0.0;
                for (output, action) in outputs.iter().zip(&self.actions) {
                    let squashed = output.tanh();
                    let error = squashed - action;
                    loss += scale * error * error;
                    self.doutputs.push(2.0 * scale * error * (1.0 - squashed * squashed));
                }
                loss
            }
            head => {
                let (likelihood, actions) = (&mut self.likelihood, &self.actions);
                likelihood.evaluate(compute.isa(), head, outputs, policy.log_std(), actions);
                let logs = likelihood.log_probabilities.iter().sum::<f32>();
                let spread = likelihood.entropies.iter().sum::<f32>();
                self.dlogs.clear();
                self.dlogs.resize(rows, -scale);
                let both = [&mut self.dlogs[..], &mut self.gradients[first..]];
                likelihood.backward(head, outputs, policy.log_std(), actions, both, -ent_weight * scale);
                self.doutputs.clone_from(&likelihood.doutputs);
                -scale * (logs + ent_weight * spread)
            }
        };
        policy.backward(compute, &self.doutputs, &mut self.policy, &mut self.gradients);
        loss
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::Space;

    use super::*;
    use crate::policy::{Bounds, NetworkConfig, ParameterInit};

    fn demonstrations(spec: &EnvironmentSpec, act: impl Fn(f32, f32) -> f32) -> Demonstrations {
        let mut random = Random::new(4);
        let observations: Vec<f32> = (0..800).map(|_| random.uniform(-1.0, 1.0)).collect();
        let actions = observations.chunks_exact(2).map(|seen| act(seen[0], seen[1])).collect();
        Demonstrations::new(spec, observations, actions).unwrap()
    }

    #[test]
    fn cloned_policies_repeat_the_demonstrations() {
        let seen = Space::symmetric(&[1.0, 1.0]);
        let box_ = Space::symmetric(&[2.0]);
        let bounds = Bounds { low: vec![-2.0], high: vec![2.0] };
        let choice = EnvironmentSpec::new("choice", seen.clone(), Space::discrete(2));
        let number = EnvironmentSpec::new("number", seen, box_);
        let sign = demonstrations(&choice, |a, b| f32::from(a + b > 0.0));
        let sum = demonstrations(&number, |a, b| a - 0.5 * b);
        let cases = [
            (&choice, Head::stochastic(&choice.action).unwrap(), &sign),
            (&number, Head::Gaussian(bounds.clone()), &sum),
            (&number, Head::SquashedGaussian(bounds.clone()), &sum),
            (&number, Head::Squashed(bounds), &sum),
        ];
        for (spec, head, demonstrations) in cases {
            let mut policy = Policy::new(spec, head, &NetworkConfig::default(), None).unwrap();
            policy.initialise(ParameterInit::Orthogonal(0.01), 0.0, &mut Random::new(1));
            let config = BehaviourCloningConfig { n_epochs: 30, ..Default::default() };
            let compute = Compute::single();
            let mut observer = |_, _| ControlFlow::Continue(());
            let losses =
                clone_behaviour(&mut policy, demonstrations, &config, &compute, &mut observer).unwrap();
            assert!(losses[29] < losses[0], "{losses:?}");
            let mut actions = vec![0.0; 400];
            let acting = crate::ActionMode::Deterministic;
            let mut memory = PolicyMemory::default();
            policy.act(&compute, &demonstrations.observations, acting, &mut memory, &mut actions).unwrap();
            let errors = actions.iter().zip(&demonstrations.actions).map(|(a, b)| (a - b).abs());
            let mean = errors.sum::<f32>() / 400.0;
            assert!(mean < 0.06, "{:?}: {mean}", policy.head);
        }
    }

    #[test]
    fn actions_of_another_space_are_refused() {
        let spec = EnvironmentSpec::new("choice", Space::symmetric(&[1.0]), Space::discrete(2));
        let error = Demonstrations::new(&spec, vec![0.0; 2], vec![0.0, 2.0]).unwrap_err().to_string();
        assert!(error.starts_with("the action of step 1"), "{error}");
        assert!(Demonstrations::new(&spec, vec![0.0; 3], vec![0.0; 2]).is_err());
    }
}
