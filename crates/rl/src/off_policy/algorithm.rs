//! The training loop of off-policy methods.

use opendr_engine::environment::{EnvironmentSpec, StateReader};
use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_simulation::vector::VecEnvironment;

use super::{Experience, OffPolicyConfig};
use crate::algorithm::{Algorithm, Report, not_begun, snapshot_of};
use crate::policy::{Head, NetworkConfig, ParameterInit, Policy};
use crate::prior::{DemonstratedSteps, DemonstrationReplay};
use crate::saved_state::SavedState;

/// What DQN, TD3 and SAC have in common: settings, policy, random numbers, collected steps and report.
pub(crate) struct OffPolicyBase {
    pub config: OffPolicyConfig,
    pub compute: Compute,
    pub random: Random,
    pub policy: Policy,
    /// Gradient steps so far.
    pub updates: u64,
    pub report: Report,
    /// Steps of a prior that take part in every batch; none without demonstrations.
    pub demonstrations: Option<DemonstrationReplay>,
    /// None before the first iteration.
    experience: Option<Experience>,
}

/// An off-policy method: what it adds to the shared training loop. [`Algorithm`] is implemented for each.
pub(crate) trait OffPolicyAlgorithm {
    /// Name of the method, as in [`Algorithm::name`].
    const NAME: &'static str;
    /// Names of all arrays of a saved state; the first is that of the policy's parameters.
    const ROWS: &'static [&'static str];

    fn base(&self) -> &OffPolicyBase;

    fn base_mut(&mut self) -> &mut OffPolicyBase;

    /// Writes the next actions after the warm-up: those of the policy, with exploration.
    fn explore(&mut self, experience: &mut Experience, total_timesteps: u64);

    /// Is called after each step of all environments.
    fn on_step(&mut self, _experience: &Experience) {}

    /// Takes one gradient step.
    fn learn(&mut self, experience: &Experience) -> Result<()>;

    /// Copies a replaced policy into the target policy, if there is one.
    fn reset_target(&mut self) {}

    /// Adds target, critics, optimisers and counters to a state that holds the policy.
    fn save_networks(&self, state: &mut SavedState);

    /// Reads what [`Self::save_networks`] wrote, in the same order.
    fn load_networks(
        &mut self,
        state: &SavedState,
        words: &mut StateReader<'_>,
        environments: usize,
    ) -> Result<()>;
}

impl OffPolicyBase {
    /// Creates the policy with random parameters.
    pub fn new(
        config: &OffPolicyConfig,
        network: &NetworkConfig,
        head: Head,
        spec: &EnvironmentSpec,
    ) -> Result<Self> {
        let mut policy = Policy::new(spec, head, network, config.clip())?;
        let mut random = Random::from_key([config.seed, 0]);
        policy.initialise(ParameterInit::Uniform, 0.0, &mut random);
        Ok(Self {
            config: config.clone(),
            compute: Compute::single(),
            random,
            policy,
            updates: 0,
            report: Report::default(),
            demonstrations: None,
            experience: None,
        })
    }

    /// Sets the share of demonstrations in every batch.
    pub fn set_demonstrations(&mut self, steps: &DemonstratedSteps, share: f32) -> Result<()> {
        self.demonstrations = Some(DemonstrationReplay::new(&self.policy, steps, share)?);
        Ok(())
    }

    fn take_experience(&mut self, environments: &mut dyn VecEnvironment) -> Result<Experience> {
        match self.experience.take() {
            Some(experience) => Ok(experience),
            None => Experience::begin(environments, &mut self.policy, &self.config),
        }
    }

    fn keep_experience(&mut self, experience: Experience) {
        self.report.count(experience.interaction.timesteps, &experience.interaction.episodes);
        experience.interaction.report_shielded(&mut self.report);
        self.experience = Some(experience);
    }
}

/// Takes `train_freq` steps in each environment, then the gradient steps that follow them.
fn collect_and_learn<A: OffPolicyAlgorithm>(
    algorithm: &mut A,
    environments: &mut dyn VecEnvironment,
    experience: &mut Experience,
    total_timesteps: u64,
) -> Result<()> {
    for _ in 0..algorithm.base().config.train_freq {
        let base = algorithm.base_mut();
        if base.config.takes_random_actions(experience.interaction.timesteps) {
            experience.sample_actions(&base.policy, &mut base.random);
        } else {
            algorithm.explore(experience, total_timesteps);
        }
        experience.step(environments, &mut algorithm.base_mut().policy)?;
        algorithm.on_step(experience);
    }
    for _ in 0..experience.gradient_steps(&algorithm.base().config) {
        algorithm.learn(experience)?;
    }
    Ok(())
}

impl<A: OffPolicyAlgorithm> Algorithm for A {
    fn name(&self) -> &'static str {
        A::NAME
    }

    fn policy(&self) -> &Policy {
        &self.base().policy
    }

    fn set_policy(&mut self, policy: &Policy) -> Result<()> {
        self.base_mut().policy.take_over(policy)?;
        self.reset_target();
        Ok(())
    }

    fn report(&self) -> &Report {
        &self.base().report
    }

    fn iterate(&mut self, environments: &mut dyn VecEnvironment, total_timesteps: u64) -> Result<&Report> {
        let mut experience = self.base_mut().take_experience(environments)?;
        let outcome = collect_and_learn(self, environments, &mut experience, total_timesteps);
        self.base_mut().keep_experience(experience);
        outcome?;
        Ok(&self.base().report)
    }

    fn saved_state(&self, environments: &dyn VecEnvironment) -> Result<SavedState> {
        let base = self.base();
        let experience = base.experience.as_ref().ok_or_else(|| not_begun(A::NAME))?;
        let mut state = SavedState::new(A::NAME, snapshot_of(environments)?);
        state.add(A::ROWS[0], &base.policy.parameters);
        self.save_networks(&mut state);
        experience.save(&mut state, &base.policy, &base.random);
        Ok(state)
    }

    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()> {
        let mut words = state.words.read(A::NAME)?;
        state.fill(A::ROWS[0], &mut self.base_mut().policy.parameters)?;
        self.load_networks(state, &mut words, environments.count())?;
        let base = self.base_mut();
        let (mut experience, random) =
            Experience::load(state, &mut words, environments, &mut base.policy, &base.config)?;
        words.finish()?;
        experience.interaction.resume(state.environments(), environments, &base.policy.encoder)?;
        base.random = random;
        base.keep_experience(experience);
        Ok(())
    }

    fn array_names(&self) -> &'static [&'static str] {
        A::ROWS
    }
}
