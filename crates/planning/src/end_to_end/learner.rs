//! The learner.

use std::ops::ControlFlow;
use std::path::Path;

use opendr_engine::environment::{Environment, Step};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    Acting, Algorithm as _, EvaluationProtocol, EvaluationReport, Policy, Ppo, Report, evaluate_controller,
};
use opendr_simulation::make;
use opendr_simulation::uav_corridor::Remembered;
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment as _};

use super::{DepthPilot, EndToEndPlanningParams, SternRewards};

/// Flies a drone between obstacles by its depth camera (OpenDR's `EndToEndPlanningRLLearner`): PPO on what the drone
/// remembers of its flight.
///
/// ```
/// use opendr_planning::EndToEndPlanning;
///
/// let mut planning = EndToEndPlanning::pretrained()?;
/// // 64 x 64 bytes of depth, 255 for 15 m, and the target in metres: ahead, left, up.
/// let mut observation = vec![255.0; 64 * 64 + 3];
/// observation[64 * 64..].copy_from_slice(&[5.0, 0.0, 0.0]);
/// let [heading, _] = planning.infer(&observation, true)?;
/// assert!(heading.abs() < 0.5, "nothing is in the way");
/// # Ok::<_, opendr_engine::Error>(())
/// ```
pub struct EndToEndPlanning {
    params: EndToEndPlanningParams,
    pilot: Option<DepthPilot>,
    random: Random,
}

/// The corridor whose observations are OpenDR's.
const CORRIDOR: &str = "UavDepthCorridor-v1";
/// What `cargo run --release -p opendr-planning --example ppo_corridor 0 end_to_end_planning.safetensors` trained.
const PRETRAINED: &[u8] =
    include_bytes!("../../../../models/weights/end_to_end_planning/uav_depth_corridor.safetensors");

impl EndToEndPlanning {
    /// A learner that has learnt nothing.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range.
    pub fn new(params: EndToEndPlanningParams) -> Result<Self> {
        params.check()?;
        let random = Random::at([params.seed, 1]);
        Ok(Self { params, pilot: None, random })
    }

    /// With the policy that comes with OpenDR.
    ///
    /// # Errors
    /// None that its tests do not exclude.
    pub fn pretrained() -> Result<Self> {
        let mut learner = Self::new(EndToEndPlanningParams::default())?;
        learner.set_policy(Policy::from_bytes(PRETRAINED)?)?;
        Ok(learner)
    }

    /// Its settings.
    pub fn params(&self) -> &EndToEndPlanningParams {
        &self.params
    }

    /// What it has learnt; none before `fit` or `load`.
    pub fn policy(&self) -> Option<&Policy> {
        self.pilot.as_ref().map(DepthPilot::policy)
    }

    fn set_policy(&mut self, policy: Policy) -> Result<()> {
        let space = make(CORRIDOR)?.spec().observation.clone();
        self.pilot = Some(DepthPilot::new(policy, space)?);
        Ok(())
    }

    /// Trains in `environments`, corridors of any kind that show OpenDR's dictionary, from the policy that is there, for
    /// `iters` steps or until `observer`, asked after each update, breaks off. Checkpoints, policies as files, go into the
    /// folder `checkpoints`, where one is given.
    ///
    /// # Errors
    /// `InvalidInput` without environments and for others than corridors, `Io` for checkpoints, `Internal` when learning diverges.
    pub fn fit(
        &mut self,
        environments: Vec<Box<dyn Environment>>,
        checkpoints: Option<&Path>,
        observer: &mut dyn FnMut(&Report) -> Result<ControlFlow<()>>,
    ) -> Result<Report> {
        let (config, params) = (self.params.ppo(environments.len()), self.params.clone());
        let remembered = environments
            .into_iter()
            .map(|inner| Ok(Box::new(SternRewards(Remembered::new(inner)?)) as Box<dyn Environment>));
        let remembered = remembered.collect::<Result<Vec<_>>>()?;
        let mut corridors = EnvironmentVector::new(remembered, Autoreset::SameStep, params.threads)?;
        let compute = Compute::with_threads(params.threads);
        let mut ppo = Ppo::new(&config, corridors.spec())?.with_compute(compute);
        if let Some(policy) = self.policy() {
            ppo.set_policy(policy)?;
        }
        let mut due = params.checkpoint_after_iter;
        let report = ppo.train(&mut corridors, params.iters, &mut |event| {
            let steps = event.report.timesteps;
            if let Some(folder) = checkpoints.filter(|_| params.checkpoint_after_iter > 0 && steps >= due) {
                std::fs::create_dir_all(folder)?;
                let name = format!("end_to_end_planning_{steps}_steps.safetensors");
                event.learner.policy().save(&folder.join(name))?;
                due = steps - steps % params.checkpoint_after_iter + params.checkpoint_after_iter;
            }
            observer(event.report)
        })?;
        let report = report.clone();
        self.set_policy(ppo.policy().clone())?;
        Ok(report)
    }

    /// Flies the episodes of a protocol. What the learner remembers of its own flight stays.
    ///
    /// # Errors
    /// `InvalidInput` before a policy is there, and for an environment that is no corridor.
    pub fn eval(
        &self,
        environment: &mut dyn Environment,
        protocol: &EvaluationProtocol,
    ) -> Result<EvaluationReport> {
        let policy = self.policy().ok_or_else(untrained)?.clone();
        let mut pilot = DepthPilot::new(policy, environment.spec().observation.clone())?;
        let success = |step: &Step| step.info.get("success").map(|success| success > 0.5);
        if protocol.deterministic {
            return evaluate_controller(&mut pilot, environment, protocol, &success);
        }
        let mut random = Random::at([protocol.first_seed, 1]);
        evaluate_controller(&mut Sampled(&mut pilot, &mut random), environment, protocol, &success)
    }

    /// Heading and change of yaw, each in [-1, 1] for +-22.5 degrees, for the next observation of a flight: OpenDR's dictionary, 64 x 64
    /// bytes of depth and then the three numbers of the target. It remembers the flight until [`reset`](Self::reset).
    ///
    /// # Errors
    /// `InvalidInput` before a policy is there, and for what is no such observation.
    pub fn infer(&mut self, observation: &[f32], deterministic: bool) -> Result<[f32; 2]> {
        let acting = if deterministic { Acting::Deterministic } else { Acting::Sampled(&mut self.random) };
        self.pilot.as_mut().ok_or_else(untrained)?.fly(observation, acting)
    }

    /// Forgets the flight: another begins.
    pub fn reset(&mut self) {
        if let Some(pilot) = &mut self.pilot {
            pilot.reset();
        }
    }

    /// Writes the policy as a file, whole or not at all.
    ///
    /// # Errors
    /// `InvalidInput` before a policy is there, and `Io`.
    pub fn save(&self, path: &Path) -> Result<()> {
        self.policy().ok_or_else(untrained)?.save(path)
    }

    /// Reads a policy that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// `NotFound`, `Format`, and `InvalidInput` for a policy of something else.
    pub fn load(&mut self, path: &Path) -> Result<()> {
        self.set_policy(Policy::load(path)?)
    }
}

/// A pilot that acts by chance.
struct Sampled<'a>(&'a mut DepthPilot, &'a mut Random);

impl opendr_engine::environment::Controller for Sampled<'_> {
    fn reset(&mut self) {
        self.0.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        action.copy_from_slice(&self.0.fly(observation, Acting::Sampled(self.1))?);
        Ok(())
    }
}

fn untrained() -> Error {
    Error::invalid_input(
        "there is no policy yet; fit or load one, or begin with EndToEndPlanning::pretrained",
    )
}
