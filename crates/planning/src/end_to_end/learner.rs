//! The learner.

use opendr_engine::data::Observation;
use opendr_engine::environment::{EnvironmentSource, Space};
use opendr_engine::learner::{FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params as _;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Random, Result, Statistics, Task};
use opendr_kernels::Compute;
use opendr_rl::{Acting, POLICY, Policy, PolicyMemory, PolicyParams, fit_policy, numbers_from_observation};
use opendr_simulation::uav_corridor::FlightMemory;

use super::method::{EndToEndPlanningFitParams, PpoInCorridors};

/// Flies a drone between obstacles by its depth camera (OpenDR's `EndToEndPlanningRLLearner`): PPO on what the drone
/// remembers of its flight, which corrects what two steps of looking ahead propose.
///
/// An observation is OpenDR's dictionary: `depth_cam`, 64 x 64 bytes of depth, 255 for 15 m, and `moving_target`, the way to
/// the target in metres: ahead, left, up. The answer is heading and change of yaw, each in [-1, 1] for +-22.5
/// degrees. A stream is a flight: `reset` begins another.
pub struct EndToEndPlanningRl {
    policy: Policy,
    params: PolicyParams,
    /// Of the observations that come in.
    space: Space,
    compute: Compute,
}

/// What is remembered of a flight.
#[derive(Default)]
pub struct FlightState {
    flight: FlightMemory,
    memory: PolicyMemory,
    numbers: Vec<f32>,
    random: Option<Random>,
}

/// The corridor whose observations are OpenDR's.
const CORRIDOR: &str = "UavDepthCorridor-v1";
/// Heading and change of yaw.
const AXES: usize = 2;

impl Learner for EndToEndPlanningRl {
    const SPEC: Spec = Spec::new("end_to_end_planning", Task::EndToEndPlanning)
        .class("EndToEndPlanningRLLearner")
        .about("Flies a drone between obstacles, from its depth camera to heading and yaw.");
    type Params = PolicyParams;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = FlightState;

    fn load(model: &Model, params: PolicyParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "a drone is flown by the processor, not by {device}; give \"cpu\" or \"auto\""
            )));
        }
        let policy = Policy::from_bytes(&model.file(POLICY)?)?;
        let axes = Space::symmetric(&[1.0; AXES]);
        if (policy.observation(), policy.action()) != (&FlightMemory::space()?, &axes) {
            return Err(Error::format(format!(
                "a policy that sees {} and gives {} flies no corridor; train one by {}",
                policy.observation(),
                policy.action(),
                Self::SPEC.class
            )));
        }
        let space = opendr_simulation::make(CORRIDOR)?.spec().observation.clone();
        Ok(Self { policy, params, space, compute: Compute::single() })
    }

    fn params(&self) -> &PolicyParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PolicyParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut FlightState, seen: &Observation, target: &mut RlTarget) -> Result<()> {
        let FlightState { flight, memory, numbers, random } = state;
        numbers_from_observation(&self.space, seen, numbers)?;
        let (mut known, mut correction) = ([0.0; FlightMemory::LEN], [0.0; AXES]);
        flight.see(&self.space, numbers, &mut known)?;
        let acting = match self.params.deterministic {
            true => Acting::Deterministic,
            false => Acting::Sampled(random.get_or_insert_with(|| Random::new(self.params.seed))),
        };
        self.policy.act(&self.compute, &known, acting, memory, &mut correction)?;
        let action = flight.corrected(correction);
        flight.acted(action);
        target.values.clear();
        target.values.extend_from_slice(&action);
        Ok(())
    }
}

impl LearnerRl for EndToEndPlanningRl {
    type FitParams = EndToEndPlanningFitParams;

    fn fit(
        base: Option<&Model>,
        params: &PolicyParams,
        fit_params: &EndToEndPlanningFitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_policy::<PpoInCorridors>(base, &params.to_map(), fit_params, env, val_env, job)
    }
}
