//! The learner of end-to-end planning.

use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::data::Observation;
<<<<<<< HEAD
use opendr_engine::environment::Space;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
=======
use opendr_engine::environment::{Environment, EnvironmentSource, Space};
use opendr_engine::learner::{FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::params::Params as _;
>>>>>>> bb3b7a7f
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Random, Result, Task};
use opendr_kernels::Compute;
<<<<<<< HEAD
use opendr_rl::{ActionMode, POLICY_FILE, Policy, PolicyMemory, PolicyParams, numbers_from_observation};
use opendr_simulation::uav_corridor::FlightMemory;

=======
use opendr_rl::{
    ActionMode, POLICY_FILE, Policy, PolicyMemory, PolicyParams, fit_policy, numbers_from_observation,
};
use opendr_simulation::uav_corridor::{FlightMemory, FlightMemoryWrapper, Surroundings};

use super::learn_surroundings;
use super::method::{EndToEndPlanningFitParams, PpoInCorridors};

>>>>>>> bb3b7a7f
/// Flies a drone between obstacles by its depth camera (OpenDR's `EndToEndPlanningRLLearner`). The policy, trained by PPO,
/// receives the memory of the flight and corrects the proposal of a planner with a horizon of two steps.
///
/// An observation is OpenDR's dictionary: `depth_cam`, 64 x 64 bytes of depth, where 255 is 15 m, and `moving_target`, the
/// vector to the target in metres: forward, left, up. The action is heading and change of yaw, each in [-1, 1] for +-22.5
/// degrees. A stream is a flight; `reset` starts another.
pub struct EndToEndPlanningRl {
    policy: Policy,
    params: PolicyParams,
    surroundings: Option<Arc<Surroundings>>,
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
/// File of the surroundings in a container: little-endian f32 values.
const SURROUNDINGS: &str = "surroundings.f32";

/// Reads the surroundings of a container; none for a policy that was trained without them.
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

/// Adds the surroundings to the container written by a training.
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

/// Surroundings that are learnt when the first environment has proved to be a corridor.
struct SharedSurroundings<'a> {
    known: Mutex<Option<Option<Arc<Surroundings>>>>,
    find: &'a (dyn Fn() -> Result<Option<Arc<Surroundings>>> + Sync),
}

impl SharedSurroundings<'_> {
    fn get(&self) -> Result<Option<Arc<Surroundings>>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        match &*known {
            Some(known) => Ok(known.clone()),
            None => {
                let found = (self.find)()?;
                *known = Some(found.clone());
                Ok(found)
            }
        }
    }
}

/// A source of corridors with the map of the flight.
struct MemorySource<'a> {
    source: &'a dyn EnvironmentSource,
    surroundings: &'a SharedSurroundings<'a>,
}

impl EnvironmentSource for MemorySource<'_> {
    fn make(&self) -> Result<Box<dyn Environment>> {
        let corridor = FlightMemoryWrapper::new(self.source.make()?)?;
        Ok(match self.surroundings.get()? {
            None => Box::new(corridor),
            Some(surroundings) => Box::new(corridor.with_surroundings(surroundings)),
        })
    }
}

impl Learner for EndToEndPlanningRl {
    const SPEC: Spec = Spec::new("end_to_end_planning", Task::EndToEndPlanning)
        .class("EndToEndPlanningRLLearner")
        .about("Flies a drone between obstacles: maps its depth images to heading and yaw.");
    type Params = PolicyParams;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = FlightState;

    fn load(model: &Model, params: PolicyParams, device: Device) -> Result<Self> {
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
        let surroundings = surroundings_of(model)?;
        Ok(Self { policy, params, surroundings, space, compute: Compute::single() })
    }

    fn params(&self) -> &PolicyParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PolicyParams {
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
        let flight = flight.get_or_insert_with(|| memory_with(self.surroundings.as_ref()));
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
<<<<<<< HEAD
=======

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
        let compute = Compute::with_threads(fit_params.training.num_workers);
        let surroundings = SharedSurroundings {
            known: Mutex::new(None),
            find: &|| match (base, fit_params.surroundings_flights) {
                (Some(base), _) => surroundings_of(base),
                (None, 0) => Ok(None),
                (None, flights) => {
                    let learnt = learn_surroundings(flights, fit_params.seed, &compute, job.progress)?;
                    Ok(Some(Arc::new(learnt)))
                }
            },
        };
        let remembered = |source| MemorySource { source, surroundings: &surroundings };
        let (env, val_env) = (remembered(env), val_env.map(remembered));
        let val_env = val_env.as_ref().map(|source| source as &dyn EnvironmentSource);
        let statistics =
            fit_policy::<PpoInCorridors>(base, &params.to_map(), fit_params, &env, val_env, job)?;
        if let Some(surroundings) = surroundings.get()? {
            add_surroundings(&surroundings, job)?;
        }
        Ok(statistics)
    }
}
>>>>>>> bb3b7a7f
