//! Steps of a prior to learn from.

use std::ops::ControlFlow;

use opendr_engine::environment::{Controller, Environment, EnvironmentSpec, ResetOptions};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;

use crate::algorithm::Algorithm;
use crate::behaviour_cloning::{BehaviourCloningConfig, Demonstrations, clone_behaviour};
use crate::policy::Policy;
use crate::replay_buffer::{ReplayBuffer, Transition, Transitions};

/// Steps of a controller with their rewards: what the replay buffers of [`Sac`](crate::Sac) and [`Td3`](crate::Td3) are filled with.
#[derive(Debug, Clone, PartialEq)]
pub struct DemonstratedSteps {
    spec: EnvironmentSpec,
    observations: Vec<f32>,
    actions: Vec<f32>,
    rewards: Vec<f32>,
    next_observations: Vec<f32>,
    terminated: Vec<bool>,
    returns: Vec<f64>,
}

impl DemonstratedSteps {
    /// Records what a controller does in episodes that begin with these seeds.
    ///
    /// # Errors
    /// Those of the environment and of the controller, `InvalidInput` where there is no episode.
    pub fn record(
        controller: &mut dyn Controller,
        environment: &mut dyn Environment,
        seeds: impl IntoIterator<Item = u64>,
    ) -> Result<Self> {
        let spec = environment.spec().clone();
        let mut observation = vec![0.0; spec.observation.len()];
        let mut action = vec![0.0; spec.action.len()];
        let mut steps = Self {
            spec,
            observations: Vec::new(),
            actions: Vec::new(),
            rewards: Vec::new(),
            next_observations: Vec::new(),
            terminated: Vec::new(),
            returns: Vec::new(),
        };
        for seed in seeds {
            environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
            controller.reset();
            let mut earned = 0.0;
            loop {
                controller.act(&observation, &mut action)?;
                steps.spec.action.check(&action)?;
                steps.observations.extend_from_slice(&observation);
                steps.actions.extend_from_slice(&action);
                let step = environment.step(&action, &mut observation)?;
                earned += step.reward;
                steps.rewards.push(step.reward as f32);
                steps.next_observations.extend_from_slice(&observation);
                steps.terminated.push(step.terminated);
                if step.is_over() {
                    break;
                }
            }
            steps.returns.push(earned);
        }
        match steps.len() {
            0 => Err(Error::invalid_input("no episodes to demonstrate; give at least one seed")),
            _ => Ok(steps),
        }
    }

    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.rewards.len()
    }

    /// Returns whether there is no step; never after [`Self::record`].
    pub fn is_empty(&self) -> bool {
        self.rewards.is_empty()
    }

    /// Returns the sum of rewards of each episode.
    pub fn returns(&self) -> &[f64] {
        &self.returns
    }

    /// Returns the steps as pairs of observations and actions, for [`clone_behaviour`].
    ///
    /// # Errors
    /// As [`Demonstrations::new`].
    pub fn demonstrations(&self) -> Result<Demonstrations> {
        Demonstrations::new(&self.spec, self.observations.clone(), self.actions.clone())
    }
}

/// Steps of a prior that keep their place in every minibatch.
#[derive(Debug, Clone)]
pub(crate) struct DemonstrationReplay {
    buffer: ReplayBuffer,
    share: f32,
}

impl DemonstrationReplay {
    pub fn new(policy: &Policy, steps: &DemonstratedSteps, share: f32) -> Result<Self> {
        if !(share > 0.0 && share < 1.0) {
            return Err(Error::invalid_param(format!(
                "a share of {share} of demonstrations in a minibatch; give more than 0 and less than 1"
            )));
        }
        if (&steps.spec.observation, &steps.spec.action) != (policy.observation(), policy.action()) {
            return Err(Error::invalid_input(format!(
                "demonstrations of {} in {} do not fit a policy of {} in {}; record them in the environment of the training",
                steps.spec.action,
                steps.spec.observation,
                policy.action(),
                policy.observation()
            )));
        }
        let [seen, done] = [steps.spec.observation.len(), steps.spec.action.len()];
        let mut actions = vec![0.0; steps.actions.len()];
        policy.head.distribution_actions(&steps.actions, &mut actions);
        let mut buffer = ReplayBuffer::new(steps.len(), seen, done)?;
        for step in 0..steps.len() {
            let row = step * seen..(step + 1) * seen;
            buffer.add(Transition {
                observation: &steps.observations[row.clone()],
                action: &actions[step * done..(step + 1) * done],
                reward: steps.rewards[step],
                next_observation: &steps.next_observations[row],
                terminated: steps.terminated[step],
                shielded: false,
            });
        }
        Ok(Self { buffer, share })
    }

    /// Rows of a minibatch that are demonstrations: at least one, and never all.
    pub fn rows(&self, count: usize) -> usize {
        ((self.share * count as f32).round() as usize).clamp(1, count.saturating_sub(1).max(1)).min(count)
    }

    /// Draws `count` steps behind those that are drawn already.
    pub fn append(&self, count: usize, random: &mut Random, drawn: &mut Transitions) {
        self.buffer.append(count, random, drawn);
    }
}

/// Begins a training from a prior by cloning its behaviour: the policy of `algorithm` becomes one that does what `steps` show. The mean
/// loss of each epoch is the result. Let the values learn before the actor moves (`actor_starts`): they know nothing yet.
///
/// # Errors
/// As [`clone_behaviour`] and [`Algorithm::set_policy`].
pub fn begin_as_clone<A: Algorithm + ?Sized>(
    algorithm: &mut A,
    steps: &DemonstratedSteps,
    config: &BehaviourCloningConfig,
    compute: &Compute,
) -> Result<Vec<f64>> {
    let mut policy = algorithm.policy().clone();
    let demonstrations = steps.demonstrations()?;
    let mut observer = |_, _| ControlFlow::Continue(());
    let losses = clone_behaviour(&mut policy, &demonstrations, config, compute, &mut observer)?;
    algorithm.set_policy(&policy)?;
    Ok(losses)
}
