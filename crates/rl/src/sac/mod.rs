//! Soft actor-critic (Haarnoja et al., 2018), as Stable-Baselines3 has it.

mod squashed;

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute};
use opendr_simulation::vector::VecEnvironment;

use squashed::Squashed;

use crate::algorithm::{Algorithm, Report, diverged, not_begun, snapshot_of};
use crate::off_policy::{Experience, OffPolicyConfig};
use crate::policy::{Beginning, Bounds, Head, NetworkConfig, Policy, PolicyMemory};
use crate::preset::Preset;
use crate::prior::{DemonstratedSteps, DemonstrationReplay};
use crate::replay_buffer::{self, Transitions};
use crate::saved_state::SavedState;
use crate::twin_critics::{self, TwinCritics};

/// Settings of [`Sac`]. Names and defaults are those of Stable-Baselines3.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct SacConfig {
    /// What off-policy learners share.
    #[param(flatten)]
    pub off_policy: OffPolicyConfig,
    /// The networks of policy and values.
    #[param(flatten, net_arch = vec![256, 256], activation_fn = crate::Hidden::Relu)]
    pub network: NetworkConfig,
    /// Weight of the entropy; none is found while learning.
    #[param(range = 0.0..=1e6)]
    pub ent_coef: Option<f32>,
    /// What that weight is begun with.
    #[param(default = 1.0, range = 1e-9..=1e6)]
    pub ent_coef_init: f32,
    /// The entropy to be held; none is minus the number of axes.
    #[param(range = -1e6..=1e6)]
    pub target_entropy: Option<f32>,
    /// Gradient steps between two moves of the targets.
    #[param(default = 1, range = 1..=1_000_000)]
    pub target_update_interval: u64,
}

/// SAC: a policy that earns much while it acts as freely as that allows; for continuous actions.
pub struct Sac {
    config: SacConfig,
    compute: Compute,
    random: Random,
    policy: Policy,
    actor_adam: Adam,
    critics: TwinCritics,
    log_ent_coef: [f32; 1],
    ent_adam: Adam,
    target_entropy: f32,
    experience: Option<Experience>,
    demonstrations: Option<DemonstrationReplay>,
    memory: Memory,
    updates: u64,
    report: Report,
}

#[derive(Debug, Clone, Default)]
struct Memory {
    drawn: Transitions,
    /// The policy on what was seen, and on what came next.
    now: PolicyMemory,
    next: PolicyMemory,
    sampled: Squashed,
    sampled_next: Squashed,
    wanted: Vec<f32>,
    gradients: Vec<f32>,
}

const NAME: &str = "sac";

/// The rows of its state.
const ROWS: &[&str] = &[
    "policy",
    "policy_adam_first",
    "policy_adam_second",
    "ent_coef",
    "ent_coef_adam_first",
    "ent_coef_adam_second",
    twin_critics::ROWS[0][0],
    twin_critics::ROWS[0][1],
    twin_critics::ROWS[0][2],
    twin_critics::ROWS[0][3],
    twin_critics::ROWS[1][0],
    twin_critics::ROWS[1][1],
    twin_critics::ROWS[1][2],
    twin_critics::ROWS[1][3],
    twin_critics::ROWS[2][0],
    twin_critics::ROWS[2][1],
    twin_critics::ROWS[2][2],
    twin_critics::ROWS[2][3],
    replay_buffer::ROWS[0],
    replay_buffer::ROWS[1],
    replay_buffer::ROWS[2],
    replay_buffer::ROWS[3],
    replay_buffer::ROWS[4],
    replay_buffer::ROWS[5],
];

impl SacConfig {
    /// The settings of rl-zoo for an environment, where it has some.
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        let mut config = Self::default();
        match id {
            "Pendulum-v1" => {
                config.off_policy.learning_rate = 1e-3;
                Some(Preset { environments: 1, timesteps: 20_000, config })
            }
            _ => None,
        }
    }
}

impl Sac {
    /// A learner for environments of this kind, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` for actions that are no bounded box, and for memory.
    pub fn new(config: &SacConfig, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.network.check_no_memory(NAME)?;
        let clip = config.off_policy.clip();
        let bounds = Bounds::of(&spec.action, true)?;
        let axes = bounds.low.len();
        let mut policy = Policy::new(spec, Head::SquashedGaussian(bounds), &config.network, clip)?;
        let mut random = Random::at([config.off_policy.seed, 0]);
        policy.initialise(Beginning::Uniform, 0.0, &mut random);
        Ok(Self {
            config: config.clone(),
            compute: Compute::single(),
            critics: TwinCritics::new(&policy.encoder, axes, &config.network, &mut random)?,
            random,
            actor_adam: Adam::new(policy.parameters.len(), AdamOptions::default()),
            log_ent_coef: [config.ent_coef.unwrap_or(config.ent_coef_init).ln()],
            ent_adam: Adam::new(1, AdamOptions::default()),
            target_entropy: config.target_entropy.unwrap_or(-(axes as f32)),
            policy,
            experience: None,
            demonstrations: None,
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

    /// Learns from steps of a prior, too: each minibatch has the share `share` of them, in (0, 1). They are no part of a
    /// [`SavedState`]; set the same ones before a training is resumed.
    ///
    /// # Errors
    /// `InvalidParam` for another share, `InvalidInput` for steps of another environment.
    pub fn set_demonstrations(&mut self, steps: &DemonstratedSteps, share: f32) -> Result<()> {
        self.demonstrations = Some(DemonstrationReplay::new(&self.policy, steps, share)?);
        Ok(())
    }

    /// Writes actions for what is seen: by chance before learning begins, then from the policy.
    fn act(&mut self, experience: &mut Experience) {
        if self.config.off_policy.acts_by_chance(experience.interaction.timesteps) {
            return experience.act_by_chance(&self.policy, self.policy.action(), &mut self.random);
        }
        let Memory { now, sampled, .. } = &mut self.memory;
        let encoded = &experience.interaction.encoded;
        let outputs = self.policy.forward(&self.compute, encoded, now);
        let axes = self.policy.head.action_len();
        sampled.sample(self.compute.isa(), outputs, axes, &mut self.random);
        experience.kept.copy_from_slice(&sampled.actions);
        self.policy.head.environment_actions(&sampled.actions, &mut experience.actions);
    }

    /// One gradient step of everything.
    fn learn(&mut self, experience: &Experience) -> Result<()> {
        let config = &self.config.off_policy;
        let (rate, timesteps) = (config.learning_rate, experience.interaction.timesteps);
        let Memory { drawn, now, next, sampled, sampled_next, wanted, .. } = &mut self.memory;
        let (compute, policy, axes) = (&self.compute, &self.policy, self.policy.head.action_len());
        let demonstrations = self.demonstrations.as_ref();
        experience.draw(policy, config.batch_size, demonstrations, &mut self.random, drawn)?;
        let outputs = policy.forward(compute, &drawn.observations, now);
        sampled.sample(compute.isa(), outputs, axes, &mut self.random);
        let weight = self.log_ent_coef[0].exp();
        // A policy that does not move has the entropy that it has.
        if self.config.ent_coef.is_none() && timesteps > config.actor_starts {
            let slope = -(sampled.mean_log_probability() + self.target_entropy);
            self.ent_adam.step(compute, rate, &mut self.log_ent_coef, &[slope]);
        }
        let outputs = policy.forward(compute, &drawn.next_observations, next);
        sampled_next.sample(compute.isa(), outputs, axes, &mut self.random);
        let rows = config.batch_size;
        let values =
            self.critics.target_values(compute, &drawn.next_observations, &sampled_next.actions, rows);
        wanted.clear();
        let next_values = values.iter().zip(&sampled_next.log_probabilities);
        for ((value, log), (reward, goes_on)) in next_values.zip(drawn.rewards.iter().zip(&drawn.continues)) {
            wanted.push(reward + goes_on * config.gamma * (value - weight * log));
        }
        let critic_loss =
            self.critics.learn(compute, [&drawn.observations, &drawn.actions], wanted, 0.5, rate);
        if !critic_loss.is_finite() {
            return Err(diverged("the loss of values", critic_loss.into(), timesteps));
        }
        let moves = timesteps > self.config.off_policy.actor_starts;
        let actor_loss = if moves { self.learn_policy(weight, rate) } else { 0.0 };
        if !actor_loss.is_finite() {
            return Err(diverged("the loss of the policy", actor_loss.into(), timesteps));
        }
        self.updates += 1;
        if self.updates.is_multiple_of(self.config.target_update_interval) {
            self.critics.follow(self.config.off_policy.tau);
        }
        let metrics = &mut self.report.metrics;
        for (name, number) in [("critic_loss", critic_loss), ("actor_loss", actor_loss), ("ent_coef", weight)]
        {
            metrics.set(name, number.into());
        }
        metrics.set("n_updates", self.updates as f64);
        Ok(())
    }

    /// Moves the policy to actions that are worth more, or freer.
    fn learn_policy(&mut self, weight: f32, learning_rate: f32) -> f32 {
        let Memory { drawn, now, sampled, gradients, .. } = &mut self.memory;
        let rows = drawn.rewards.len();
        let (value, dactions) =
            self.critics.gradient_by_actions(&self.compute, &drawn.observations, &sampled.actions, rows);
        let loss = weight * sampled.mean_log_probability() - value;
        if loss.is_finite() {
            sampled.backward(now.trunk.output(), weight / rows as f32, dactions);
            gradients.clear();
            gradients.resize(self.policy.parameters.len(), 0.0);
            self.policy.backward(&self.compute, &sampled.doutputs, now, gradients);
            self.actor_adam.step(&self.compute, learning_rate, &mut self.policy.parameters, gradients);
        }
        loss
    }

    fn advance(&mut self, environments: &mut dyn VecEnvironment, experience: &mut Experience) -> Result<()> {
        for _ in 0..self.config.off_policy.train_freq {
            self.act(experience);
            experience.step(environments, &mut self.policy)?;
        }
        for _ in 0..experience.gradient_steps(&self.config.off_policy) {
            self.learn(experience)?;
        }
        Ok(())
    }
}

impl Algorithm for Sac {
    fn name(&self) -> &'static str {
        NAME
    }

    fn policy(&self) -> &Policy {
        &self.policy
    }

    fn set_policy(&mut self, policy: &Policy) -> Result<()> {
        self.policy.take_over(policy)
    }

    fn report(&self) -> &Report {
        &self.report
    }

    fn iterate(&mut self, environments: &mut dyn VecEnvironment, _total_timesteps: u64) -> Result<&Report> {
        let mut experience = match self.experience.take() {
            Some(experience) => experience,
            None => Experience::begin(environments, &mut self.policy, &self.config.off_policy)?,
        };
        let outcome = self.advance(environments, &mut experience);
        let interaction = &experience.interaction;
        self.report.count(interaction.timesteps, &interaction.episodes);
        self.experience = Some(experience);
        outcome.map(|()| &self.report)
    }

    fn saved_state(&self, environments: &dyn VecEnvironment) -> Result<SavedState> {
        let experience = self.experience.as_ref().ok_or_else(|| not_begun(NAME))?;
        let mut state = SavedState::new(NAME, snapshot_of(environments)?);
        state.add(ROWS[0], &self.policy.parameters);
        state.add_adam([ROWS[1], ROWS[2]], &self.actor_adam);
        state.add(ROWS[3], &self.log_ent_coef);
        state.add_adam([ROWS[4], ROWS[5]], &self.ent_adam);
        self.critics.save(&mut state);
        state.words.push(self.updates);
        experience.save(&mut state, &self.policy, &self.random);
        Ok(state)
    }

    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()> {
        let mut words = state.words.read(NAME)?;
        state.fill(ROWS[0], &mut self.policy.parameters)?;
        state.fill_adam([ROWS[1], ROWS[2]], &mut self.actor_adam, &mut words)?;
        state.fill(ROWS[3], &mut self.log_ent_coef)?;
        state.fill_adam([ROWS[4], ROWS[5]], &mut self.ent_adam, &mut words)?;
        self.critics.load(state, &mut words)?;
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
