//! The learner of end-to-end planning.

use opendr_engine::data::Observation;
use opendr_engine::environment::Space;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Random, Result, Task};
use opendr_kernels::Compute;
use opendr_rl::{ActionMode, POLICY_FILE, Policy, PolicyMemory, numbers_from_observation};
use opendr_simulation::uav_corridor::FlightMemory;

use super::flight_models::FlightModels;

/// Parameters of a flight.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct FlightParams {
    /// Whether the policy takes its most likely actions instead of sampling.
    #[param(default = true, live)]
    pub deterministic: bool,
    /// Seed of sampled actions, at the start of a stream.
    #[param(default = 0)]
    pub seed: u64,
}

/// Flies a drone between obstacles by its depth camera (OpenDR's `EndToEndPlanningRLLearner`). The policy, trained by PPO,
/// receives the memory of the flight and corrects the proposal of a planner with a horizon of two steps.
///
/// An observation is OpenDR's dictionary: `depth_cam`, 64 x 64 bytes of depth, where 255 is 15 m, and `moving_target`, the
/// vector to the target in metres: forward, left, up. The action is heading and change of yaw, each in [-1, 1] for +-22.5
/// degrees. A stream is a flight; `reset` starts another.
pub struct EndToEndPlanningRl {
    policy: Policy,
    params: FlightParams,
    models: FlightModels,
    /// Space of the input observations.
    space: Space,
    compute: Compute,
}

/// State of a flight.
#[derive(Default)]
pub struct FlightState {
    flight: Option<FlightMemory>,
    memory: PolicyMemory,
    numbers: Vec<f32>,
    random: Option<Random>,
}

/// Environment with the observations of OpenDR.
const CORRIDOR: &str = "UavDepthCorridor-v1";
/// Number of action axes: heading and change of yaw.
const AXES: usize = 2;
impl Learner for EndToEndPlanningRl {
    const SPEC: Spec = Spec::new("end_to_end_planning", Task::EndToEndPlanning)
        .class("EndToEndPlanningRLLearner")
        .about("Flies a drone between obstacles: maps its depth images to heading and yaw.");
    type Params = FlightParams;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = FlightState;

    fn load(model: &Model, params: FlightParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "end-to-end planning runs on the CPU, not on {device}; give \"cpu\" or \"auto\""
            )));
        }
        let policy = Policy::from_bytes(&model.file(POLICY_FILE)?)?;
        let axes = Space::symmetric(&[1.0; AXES]);
        if (policy.observation(), policy.action()) != (&FlightMemory::space()?, &axes) {
            return Err(Error::format(format!(
                "a policy with observations {} and actions {} does not fit a corridor; train one with {}",
                policy.observation(),
                policy.action(),
                Self::SPEC.class
            )));
        }
        let space = opendr_simulation::make(CORRIDOR)?.spec().observation.clone();
        let models = FlightModels::of(model)?;
        Ok(Self { policy, params, models, space, compute: Compute::single() })
    }

    fn params(&self) -> &FlightParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FlightParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut FlightState,
        observation: &Observation,
        target: &mut RlTarget,
    ) -> Result<()> {
        let FlightState { flight, memory, numbers, random } = state;
        numbers_from_observation(&self.space, observation, numbers)?;
        let (mut features, mut correction) = ([0.0; FlightMemory::LEN], [0.0; AXES]);
        let flight = flight.get_or_insert_with(|| self.models.memory());
        flight.update(&self.space, numbers, &mut features)?;
        let acting = match self.params.deterministic {
            true => ActionMode::Deterministic,
            false => ActionMode::Sampled(random.get_or_insert_with(|| Random::new(self.params.seed))),
        };
        self.policy.act(&self.compute, &features, acting, memory, &mut correction)?;
        let action = flight.corrected_action(correction);
        flight.record_action(action);
        target.values.clear();
        target.values.extend_from_slice(&action);
        Ok(())
    }
}
