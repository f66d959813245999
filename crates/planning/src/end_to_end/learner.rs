//! The learner.

use std::sync::Arc;

use opendr_engine::data::Observation;
use opendr_engine::environment::{Environment, EnvironmentSource, Space};
use opendr_engine::learner::{FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::params::Params as _;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Random, Result, Statistics, Task};
use opendr_kernels::Compute;
use opendr_rl::{Acting, POLICY, Policy, PolicyMemory, PolicyParams, fit_policy, numbers_from_observation};
use opendr_simulation::uav_corridor::{FlightMemory, Remembered, Surroundings};

use super::learn_surroundings;
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
    surroundings: Option<Arc<Surroundings>>,
    /// Of the observations that come in.
    space: Space,
    compute: Compute,
}

/// What is remembered of a flight.
#[derive(Default)]
pub struct FlightState {
    flight: Option<FlightMemory>,
    memory: PolicyMemory,
    numbers: Vec<f32>,
    random: Option<Random>,
}

/// The corridor whose observations are OpenDR's.
const CORRIDOR: &str = "UavDepthCorridor-v1";
/// Heading and change of yaw.
const AXES: usize = 2;
/// The file of the surroundings in a container: little-endian numbers of four bytes.
const SURROUNDINGS: &str = "surroundings.f32";

/// The surroundings in a container; containers without them are of policies trained without.
///
/// # Errors
/// `Format` for a damaged file.
pub fn surroundings_of(model: &Model) -> Result<Option<Arc<Surroundings>>> {
    if !model.manifest().files.iter().any(|file| file.name == SURROUNDINGS) {
        return Ok(None);
    }
    let bytes = model.file(SURROUNDINGS)?;
    let (numbers, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(Error::format(format!("{SURROUNDINGS} is cut off; train the policy again")));
    }
    let numbers = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Ok(Some(Arc::new(Surroundings::new(numbers)?)))
}

/// Adds surroundings to the container that a training wrote.
fn add_surroundings(surroundings: &Surroundings, job: &FitJob<'_>) -> Result<()> {
    let model = Model::open(job.model())?;
    let files = &model.manifest().files;
    let files = files.iter().map(|file| Ok((file.name.clone(), model.file(&file.name)?)));
    let files = files.collect::<Result<Vec<_>>>()?;
    let mut writer = ModelWriter::new(job.model(), model.manifest().clone())?;
    files.iter().try_for_each(|(name, bytes)| writer.add(name, bytes))?;
    let bytes = surroundings.parameters().iter().flat_map(|parameter| parameter.to_le_bytes());
    writer.add(SURROUNDINGS, &bytes.collect::<Vec<_>>())?;
    writer.finish().map(drop)
}

fn memory_with(surroundings: Option<&Arc<Surroundings>>) -> FlightMemory {
    match surroundings {
        None => FlightMemory::default(),
        Some(surroundings) => FlightMemory::default().with_surroundings(Arc::clone(surroundings)),
    }
}

/// Corridors as drones with a memory know them.
struct RememberedSource<'a> {
    source: &'a dyn EnvironmentSource,
    surroundings: Option<Arc<Surroundings>>,
}

impl EnvironmentSource for RememberedSource<'_> {
    fn make(&self) -> Result<Box<dyn Environment>> {
        let memory = memory_with(self.surroundings.as_ref());
        Ok(Box::new(Remembered::with_memory(self.source.make()?, memory)?))
    }
}

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
        let surroundings = surroundings_of(model)?;
        Ok(Self { policy, params, surroundings, space, compute: Compute::single() })
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
        let flight = flight.get_or_insert_with(|| memory_with(self.surroundings.as_ref()));
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
        fit_params.check()?;
        let surroundings = match base {
            Some(base) => surroundings_of(base)?,
            None if fit_params.surroundings_flights == 0 => None,
            None => {
                let compute = Compute::with_threads(fit_params.training.num_workers);
                let flights = fit_params.surroundings_flights;
                Some(Arc::new(learn_surroundings(flights, fit_params.seed, &compute, job.progress)?))
            }
        };
        let remembered = |source| RememberedSource { source, surroundings: surroundings.clone() };
        let (env, val_env) = (remembered(env), val_env.map(remembered));
        let val_env = val_env.as_ref().map(|source| source as &dyn EnvironmentSource);
        let statistics =
            fit_policy::<PpoInCorridors>(base, &params.to_map(), fit_params, &env, val_env, job)?;
        if let Some(surroundings) = surroundings {
            add_surroundings(&surroundings, job)?;
        }
        Ok(statistics)
    }
}
