//! Deep Q-learning (Mnih et al., 2015), as Stable-Baselines3 has it.

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, clip_gradient_norm, move_towards};
use opendr_simulation::vector::VecEnvironment;

use crate::algorithm::{Algorithm, Report, diverged, not_begun, snapshot_of};
use crate::off_policy::{Experience, OffPolicyConfig};
use crate::policy::{Beginning, Head, NetworkConfig, Policy, PolicyMemory};
use crate::preset::Preset;
use crate::replay_buffer::{self, Transitions};
use crate::saved_state::SavedState;
use crate::schedule::remaining;

/// Settings of [`Dqn`]. Names and defaults are those of Stable-Baselines3.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct DqnConfig {
    /// What off-policy learners share.
    #[param(flatten, learning_rate = 1e-4, batch_size = 32, tau = 1.0, train_freq = 4)]
    pub off_policy: OffPolicyConfig,
    /// The network of the values.
    #[param(flatten, activation_fn = crate::Hidden::Relu)]
    pub network: NetworkConfig,
    /// Steps of all environments between two moves of the target.
    #[param(default = 10_000, range = 1..=1_000_000_000, log)]
    pub target_update_interval: u64,
    /// Over which share of the training chance gives way to the policy.
    #[param(default = 0.1, range = 1e-9..=1.0)]
    pub exploration_fraction: f32,
    /// The share of actions by chance, at first.
    #[param(default = 1.0, range = 0.0..=1.0)]
    pub exploration_initial_eps: f32,
    /// The share of actions by chance, in the end.
    #[param(default = 0.05, range = 0.0..=1.0)]
    pub exploration_final_eps: f32,
    /// Gradients longer than this are cut.
    #[param(default = 10.0, range = 0.0..=1e9)]
    pub max_grad_norm: f32,
}

/// DQN: learns what each of some choices is worth, and takes the best one.
pub struct Dqn {
    config: DqnConfig,
    compute: Compute,
    random: Random,
    policy: Policy,
    target: Policy,
    adam: Adam,
    experience: Option<Experience>,
    memory: Memory,
    updates: u64,
    report: Report,
}

#[derive(Debug, Clone, Default)]
struct Memory {
    drawn: Transitions,
    now: PolicyMemory,
    next: PolicyMemory,
    doutputs: Vec<f32>,
    gradients: Vec<f32>,
}

const NAME: &str = "dqn";

/// The rows of its state.
const ROWS: &[&str] = &[
    "policy",
    "policy_target",
    "policy_adam_first",
    "policy_adam_second",
    replay_buffer::ROWS[0],
    replay_buffer::ROWS[1],
    replay_buffer::ROWS[2],
    replay_buffer::ROWS[3],
    replay_buffer::ROWS[4],
    replay_buffer::ROWS[5],
];

impl DqnConfig {
    /// The settings of rl-zoo for an environment, where it has some.
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        if id != "CartPole-v1" {
            return None;
        }
        let mut config = Self {
            target_update_interval: 10,
            exploration_fraction: 0.16,
            exploration_final_eps: 0.04,
            ..Self::default()
        };
        config.network.net_arch = vec![256, 256];
        config.off_policy = OffPolicyConfig {
            learning_rate: 2.3e-3,
            batch_size: 64,
            buffer_size: 100_000,
            learning_starts: 1000,
            train_freq: 256,
            gradient_steps: Some(128),
            ..config.off_policy
        };
        Some(Preset { environments: 1, timesteps: 50_000, config })
    }
}

impl Dqn {
    /// A learner for environments of this kind, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` where actions are not one choice.
    pub fn new(config: &DqnConfig, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.network.check_no_memory(NAME)?;
        let Space::Discrete { n, start } = spec.action else {
            return Err(Error::unsupported(format!("actions are {}; dqn makes one choice", spec.action)));
        };
        let clip = config.off_policy.clip();
        let mut policy = Policy::new(spec, Head::Greedy { count: n, start }, &config.network, clip)?;
        let mut random = Random::at([config.off_policy.seed, 0]);
        policy.initialise(Beginning::Uniform, 0.0, &mut random);
        Ok(Self {
            config: config.clone(),
            compute: Compute::single(),
            random,
            adam: Adam::new(policy.parameters.len(), AdamOptions::default()),
            target: policy.clone(),
            policy,
            experience: None,
            memory: Memory::default(),
            updates: 0,
            report: Report::default(),
        })
    }

    /// The same on other threads, which change no bit.
    #[must_use]
    pub fn with_compute(self, compute: Compute) -> Self {
        Self { compute, ..self }
    }

    /// The share of actions by chance after `timesteps` steps.
    fn exploration(&self, timesteps: u64, total: u64) -> f32 {
        let done = 1.0 - remaining(timesteps, total) as f32;
        let share = (done / self.config.exploration_fraction).min(1.0);
        let (first, last) = (self.config.exploration_initial_eps, self.config.exploration_final_eps);
        first + share * (last - first)
    }

    /// Writes choices for what is seen: some by chance, all before learning begins.
    fn act(&mut self, experience: &mut Experience, total_timesteps: u64) {
        let timesteps = experience.interaction.timesteps;
        experience.act_by_chance(&self.policy, self.policy.action(), &mut self.random);
        if timesteps < self.config.off_policy.learning_starts {
            return;
        }
        let share = self.exploration(timesteps, total_timesteps);
        let memory = &mut self.memory.now;
        let encoded = &experience.interaction.encoded;
        let outputs = self.policy.forward(&self.compute, encoded, memory);
        let width = self.policy.head.outputs();
        for (action, outputs) in experience.actions.iter_mut().zip(outputs.chunks_exact(width)) {
            let explores = self.random.chance(share);
            if !explores {
                self.policy.head.most_likely(outputs, std::slice::from_mut(action));
            }
        }
        self.policy.head.distribution_actions(&experience.actions, &mut experience.kept);
        self.report.metrics.set("exploration_rate", share.into());
    }

    fn learn(&mut self, experience: &Experience) -> Result<()> {
        let config = &self.config.off_policy;
        let timesteps = experience.interaction.timesteps;
        let Memory { drawn, now, next, doutputs, gradients } = &mut self.memory;
        let (compute, width) = (&self.compute, self.policy.head.outputs());
        experience.draw(&self.policy, config.batch_size, None, &mut self.random, drawn)?;
        let next_values = self.target.forward(compute, &drawn.next_observations, next);
        let values = self.policy.forward(compute, &drawn.observations, now);
        doutputs.clear();
        doutputs.resize(values.len(), 0.0);
        let (scale, mut loss) = (1.0 / config.batch_size as f32, 0.0);
        for row in 0..config.batch_size {
            let own = row * width..(row + 1) * width;
            let best =
                next_values[own.clone()].iter().fold(f32::NEG_INFINITY, |best, value| best.max(*value));
            let wanted = drawn.rewards[row] + drawn.continues[row] * config.gamma * best;
            let at = own.start + drawn.actions[row] as usize;
            let error = values[at] - wanted;
            // Huber's loss: a square up to an error of 1.
            loss += if error.abs() < 1.0 { 0.5 * error * error } else { error.abs() - 0.5 };
            doutputs[at] = scale * error.clamp(-1.0, 1.0);
        }
        loss *= scale;
        gradients.clear();
        gradients.resize(self.policy.parameters.len(), 0.0);
        self.policy.backward(compute, doutputs, now, gradients);
        let norm = clip_gradient_norm(&mut [gradients], self.config.max_grad_norm);
        if !loss.is_finite() || !norm.is_finite() {
            return Err(diverged("the loss of values", loss.into(), timesteps));
        }
        self.adam.step(compute, config.learning_rate, &mut self.policy.parameters, gradients);
        self.updates += 1;
        self.report.metrics.set("loss", loss.into());
        self.report.metrics.set("n_updates", self.updates as f64);
        Ok(())
    }

    fn advance(
        &mut self,
        environments: &mut dyn VecEnvironment,
        experience: &mut Experience,
        total_timesteps: u64,
    ) -> Result<()> {
        let interval = self.config.target_update_interval;
        for _ in 0..self.config.off_policy.train_freq {
            self.act(experience, total_timesteps);
            let before = experience.interaction.timesteps;
            experience.step(environments, &mut self.policy)?;
            if before / interval != experience.interaction.timesteps / interval {
                let tau = self.config.off_policy.tau;
                move_towards(&mut self.target.parameters, &self.policy.parameters, tau);
            }
        }
        for _ in 0..experience.gradient_steps(&self.config.off_policy) {
            self.learn(experience)?;
        }
        Ok(())
    }
}

impl Algorithm for Dqn {
    fn name(&self) -> &'static str {
        NAME
    }

    fn policy(&self) -> &Policy {
        &self.policy
    }

    fn set_policy(&mut self, policy: &Policy) -> Result<()> {
        self.policy.take_over(policy)?;
        self.target.clone_from(&self.policy);
        Ok(())
    }

    fn report(&self) -> &Report {
        &self.report
    }

    fn iterate(&mut self, environments: &mut dyn VecEnvironment, total_timesteps: u64) -> Result<&Report> {
        let mut experience = match self.experience.take() {
            Some(experience) => experience,
            None => Experience::begin(environments, &mut self.policy, &self.config.off_policy)?,
        };
        let outcome = self.advance(environments, &mut experience, total_timesteps);
        let interaction = &experience.interaction;
        self.report.count(interaction.timesteps, &interaction.episodes);
        self.experience = Some(experience);
        outcome.map(|()| &self.report)
    }

    fn saved_state(&self, environments: &dyn VecEnvironment) -> Result<SavedState> {
        let experience = self.experience.as_ref().ok_or_else(|| not_begun(NAME))?;
        let mut state = SavedState::new(NAME, snapshot_of(environments)?);
        state.add(ROWS[0], &self.policy.parameters);
        state.add(ROWS[1], &self.target.parameters);
        state.add_adam([ROWS[2], ROWS[3]], &self.adam);
        state.words.push(self.updates);
        experience.save(&mut state, &self.policy, &self.random);
        Ok(state)
    }

    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()> {
        let mut words = state.words.read(NAME)?;
        state.fill(ROWS[0], &mut self.policy.parameters)?;
        state.fill(ROWS[1], &mut self.target.parameters)?;
        state.fill_adam([ROWS[2], ROWS[3]], &mut self.adam, &mut words)?;
        self.updates = words.word()?;
        let config = &self.config.off_policy;
        let (mut experience, random) =
            Experience::load(state, &mut words, environments, &mut self.policy, config)?;
        words.finish()?;
        experience.interaction.go_on(state.environments(), environments, &self.policy.encoder)?;
        self.random = random;
        self.report.count(experience.interaction.timesteps, &experience.interaction.episodes);
        self.experience = Some(experience);
        Ok(())
    }

    fn rows(&self) -> &'static [&'static str] {
        ROWS
    }
}
