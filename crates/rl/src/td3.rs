//! Twin delayed deep deterministic policy gradient (Fujimoto et al., 2018), as Stable-Baselines3 has it.

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, move_towards, tanh_in_place};
use opendr_simulation::vector::VecEnvironment;

use crate::algorithm::{Algorithm, Report, diverged, not_begun, snapshot_of};
use crate::off_policy::{Experience, OffPolicyConfig};
use crate::policy::{Beginning, Bounds, Head, NetworkConfig, Policy, PolicyMemory};
use crate::preset::Preset;
use crate::prior::{DemonstratedSteps, DemonstrationReplay};
use crate::replay_buffer::{self, Transitions};
use crate::saved_state::SavedState;
use crate::twin_critics::{self, TwinCritics};

opendr_engine::choices! {
    /// How the noise on actions goes on from step to step.
    pub enum ActionNoise {
        /// Each step has its own.
        Normal = "normal",
        /// It wanders (Uhlenbeck and Ornstein, 1930), so that what it pushes is pushed for a while.
        OrnsteinUhlenbeck = "ornstein_uhlenbeck",
    }
}

/// Settings of [`Td3`]. Names and defaults are those of Stable-Baselines3, but for those of the noise.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct Td3Config {
    /// What off-policy learners share.
    #[param(flatten, learning_rate = 1e-3)]
    pub off_policy: OffPolicyConfig,
    /// The networks of policy and values.
    #[param(flatten, net_arch = vec![400, 300], activation_fn = crate::Hidden::Relu)]
    pub network: NetworkConfig,
    /// Deviation of the noise on actions while exploring, where actions span [-1, 1]: rl-zoo's, Stable-Baselines3 has none.
    #[param(default = 0.1, range = 0.0..=2.0)]
    pub action_noise_std: f32,
    /// How that noise goes on.
    pub action_noise: ActionNoise,
    /// Updates of the values between two of the policy.
    #[param(default = 2, range = 1..=1_000_000)]
    pub policy_delay: u64,
    /// Deviation of the noise on the target policy's actions.
    #[param(default = 0.2, range = 0.0..=2.0)]
    pub target_policy_noise: f32,
    /// That noise lies within plus and minus this.
    #[param(default = 0.5, range = 0.0..=2.0)]
    pub target_noise_clip: f32,
}

/// TD3: a deterministic policy for continuous actions.
pub struct Td3 {
    config: Td3Config,
    compute: Compute,
    random: Random,
    policy: Policy,
    target: Policy,
    actor_adam: Adam,
    critics: TwinCritics,
    experience: Option<Experience>,
    demonstrations: Option<DemonstrationReplay>,
    memory: Memory,
    /// The noise on the actions of each environment.
    noise: Vec<f32>,
    updates: u64,
    report: Report,
}

#[derive(Debug, Clone, Default)]
struct Memory {
    drawn: Transitions,
    now: PolicyMemory,
    next: PolicyMemory,
    actions: Vec<f32>,
    doutputs: Vec<f32>,
    wanted: Vec<f32>,
    gradients: Vec<f32>,
}

const NAME: &str = "td3";

/// The time step of wandering noise, and how fast it returns to 0: those of Stable-Baselines3.
const STEP: f32 = 1e-2;
const RETURN: f32 = 0.15;

/// The rows of its state.
const ROWS: &[&str] = &[
    "policy",
    "policy_target",
    "policy_adam_first",
    "policy_adam_second",
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

impl Td3Config {
    /// The settings of rl-zoo for an environment, where it has some.
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        let (timesteps, learning_starts, action_noise_std, action_noise) = match id {
            "Pendulum-v1" => (20_000, 10_000, 0.1, ActionNoise::Normal),
            "MountainCarContinuous-v0" => (50_000, 100, 0.5, ActionNoise::OrnsteinUhlenbeck),
            _ => return None,
        };
        let mut config = Self { action_noise_std, action_noise, ..Self::default() };
        config.off_policy.learning_starts = learning_starts;
        Some(Preset { environments: 1, timesteps, config })
    }
}

impl Td3 {
    /// A learner for environments of this kind, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` for actions that are no bounded box, and for memory.
    pub fn new(config: &Td3Config, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.network.check_no_memory(NAME)?;
        let clip = config.off_policy.clip();
        let bounds = Bounds::of(&spec.action, true)?;
        let axes = bounds.low.len();
        let mut policy = Policy::new(spec, Head::Squashed(bounds), &config.network, clip)?;
        let mut random = Random::at([config.off_policy.seed, 0]);
        policy.initialise(Beginning::Uniform, 0.0, &mut random);
        Ok(Self {
            config: config.clone(),
            compute: Compute::single(),
            critics: TwinCritics::new(&policy.encoder, axes, &config.network, &mut random)?,
            random,
            actor_adam: Adam::new(policy.parameters.len(), AdamOptions::default()),
            target: policy.clone(),
            policy,
            experience: None,
            demonstrations: None,
            memory: Memory::default(),
            noise: Vec::new(),
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

    /// Writes actions for what is seen: by chance before learning begins, then the policy's with noise.
    fn act(&mut self, experience: &mut Experience) {
        if self.config.off_policy.acts_by_chance(experience.interaction.timesteps) {
            return experience.act_by_chance(&self.policy, self.policy.action(), &mut self.random);
        }
        let memory = &mut self.memory.now;
        let encoded = &experience.interaction.encoded;
        let outputs = self.policy.forward(&self.compute, encoded, memory);
        experience.kept.copy_from_slice(outputs);
        tanh_in_place(self.compute.isa(), &mut experience.kept);
        let deviation = self.config.action_noise_std;
        self.noise.resize(experience.kept.len(), 0.0);
        for (action, noise) in experience.kept.iter_mut().zip(&mut self.noise) {
            let chance = deviation * self.random.normal() as f32;
            *noise = match self.config.action_noise {
                ActionNoise::Normal => chance,
                ActionNoise::OrnsteinUhlenbeck => *noise + STEP * (chance / STEP.sqrt() - RETURN * *noise),
            };
            *action = (*action + *noise).clamp(-1.0, 1.0);
        }
        self.policy.head.environment_actions(&experience.kept, &mut experience.actions);
    }

    /// Noise does not wander from one episode into the next.
    fn calm(&mut self, experience: &Experience) {
        let axes = self.policy.head.action_len();
        for (index, noise) in self.noise.chunks_exact_mut(axes).enumerate() {
            if experience.interaction.ended(index) {
                noise.fill(0.0);
            }
        }
    }

    fn learn(&mut self, experience: &Experience) -> Result<()> {
        let config = &self.config.off_policy;
        let (rate, timesteps) = (config.learning_rate, experience.interaction.timesteps);
        let Memory { drawn, next, actions, wanted, .. } = &mut self.memory;
        let (compute, rows) = (&self.compute, config.batch_size);
        let demonstrations = self.demonstrations.as_ref();
        experience.draw(&self.policy, rows, demonstrations, &mut self.random, drawn)?;
        let outputs = self.target.forward(compute, &drawn.next_observations, next);
        actions.clear();
        actions.extend_from_slice(outputs);
        tanh_in_place(compute.isa(), actions);
        let clip = self.config.target_noise_clip;
        for action in &mut *actions {
            let noise = self.config.target_policy_noise * self.random.normal() as f32;
            *action = (*action + noise.clamp(-clip, clip)).clamp(-1.0, 1.0);
        }
        let values = self.critics.target_values(compute, &drawn.next_observations, actions, rows);
        wanted.clear();
        for (value, (reward, goes_on)) in values.iter().zip(drawn.rewards.iter().zip(&drawn.continues)) {
            wanted.push(reward + goes_on * config.gamma * value);
        }
        let loss = self.critics.learn(compute, [&drawn.observations, &drawn.actions], wanted, 1.0, rate);
        if !loss.is_finite() {
            return Err(diverged("the loss of values", loss.into(), timesteps));
        }
        self.updates += 1;
        self.report.metrics.set("critic_loss", loss.into());
        self.report.metrics.set("n_updates", self.updates as f64);
        if self.updates.is_multiple_of(self.config.policy_delay) {
            match timesteps > self.config.off_policy.actor_starts {
                true => self.learn_policy(rate, timesteps)?,
                false => self.critics.follow(self.config.off_policy.tau),
            }
        }
        Ok(())
    }

    /// Moves the policy to actions that are worth more, and all targets after their networks.
    fn learn_policy(&mut self, learning_rate: f32, timesteps: u64) -> Result<()> {
        let Memory { drawn, now, actions, doutputs, gradients, .. } = &mut self.memory;
        let (compute, rows) = (&self.compute, drawn.rewards.len());
        let outputs = self.policy.forward(compute, &drawn.observations, now);
        actions.clear();
        actions.extend_from_slice(outputs);
        tanh_in_place(compute.isa(), actions);
        let (value, dactions) =
            self.critics.gradient_by_actions_of_first(compute, &drawn.observations, actions, rows);
        if !value.is_finite() {
            return Err(diverged("the value of the policy", value.into(), timesteps));
        }
        doutputs.clear();
        doutputs.extend(actions.iter().zip(dactions).map(|(action, d)| d * (1.0 - action * action)));
        gradients.clear();
        gradients.resize(self.policy.parameters.len(), 0.0);
        self.policy.backward(compute, doutputs, now, gradients);
        self.actor_adam.step(compute, learning_rate, &mut self.policy.parameters, gradients);
        let tau = self.config.off_policy.tau;
        self.critics.follow(tau);
        move_towards(&mut self.target.parameters, &self.policy.parameters, tau);
        self.report.metrics.set("actor_loss", (-value).into());
        Ok(())
    }

    fn advance(&mut self, environments: &mut dyn VecEnvironment, experience: &mut Experience) -> Result<()> {
        for _ in 0..self.config.off_policy.train_freq {
            self.act(experience);
            experience.step(environments, &mut self.policy)?;
            self.calm(experience);
        }
        for _ in 0..experience.gradient_steps(&self.config.off_policy) {
            self.learn(experience)?;
        }
        Ok(())
    }
}

impl Algorithm for Td3 {
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
        state.add(ROWS[1], &self.target.parameters);
        state.add_adam([ROWS[2], ROWS[3]], &self.actor_adam);
        self.critics.save(&mut state);
        state.words.push(self.updates);
        state.words.push(self.noise.len() as u64);
        state.words.extend_numbers(self.noise.iter().map(|&noise| noise.into()));
        experience.save(&mut state, &self.policy, &self.random);
        Ok(state)
    }

    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()> {
        let mut words = state.words.read(NAME)?;
        state.fill(ROWS[0], &mut self.policy.parameters)?;
        state.fill(ROWS[1], &mut self.target.parameters)?;
        state.fill_adam([ROWS[2], ROWS[3]], &mut self.actor_adam, &mut words)?;
        self.critics.load(state, &mut words)?;
        self.updates = words.word()?;
        self.noise.resize(words.count(environments.count() * self.policy.head.action_len())?, 0.0);
        for noise in &mut self.noise {
            *noise = words.finite()? as f32;
        }
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
