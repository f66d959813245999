//! Training of end-to-end planning: surroundings and foresight first, then the policy.

use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::environment::{Environment, EnvironmentSource};
use opendr_engine::learner::{FitJob, LearnerRl};
use opendr_engine::model::Model;
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result, Statistics};
use opendr_kernels::Compute;
use opendr_rl::fit_policy;
use opendr_rl::prior::ShieldParams;
use opendr_simulation::uav_corridor::FlightMemoryWrapper;

use super::flight_models::FlightModels;
use super::foresight::learn_foresight;
use super::method::{EndToEndPlanningFitParams, PpoInCorridors};
use super::surroundings::learn_surroundings;
use super::{EndToEndPlanningRl, FlightParams};

/// Models that are learnt when the first environment has proved to be a corridor.
struct SharedModels<'a> {
    known: Mutex<Option<FlightModels>>,
    learn: &'a (dyn Fn() -> Result<FlightModels> + Sync),
}

impl SharedModels<'_> {
    fn get(&self) -> Result<FlightModels> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        match &*known {
            Some(known) => Ok(known.clone()),
            None => Ok(known.insert((self.learn)()?).clone()),
        }
    }
}

/// A source of corridors with the map of the flight.
struct MemorySource<'a> {
    source: &'a dyn EnvironmentSource,
    models: &'a SharedModels<'a>,
}

impl EnvironmentSource for MemorySource<'_> {
    fn make(&self) -> Result<Box<dyn Environment>> {
        let corridor = FlightMemoryWrapper::new(self.source.make()?)?;
        Ok(Box::new(self.models.get()?.propose_in(corridor)))
    }
}

/// Learns what the parameters ask for, or takes the models of `base`.
fn learn(base: Option<&Model>, params: &EndToEndPlanningFitParams, job: &FitJob<'_>) -> Result<FlightModels> {
    let threads = params.training.num_workers;
    match (base, params.surroundings_flights, params.foresight_flights) {
        (Some(base), ..) => FlightModels::of(base),
        (None, 0, 0) => Ok(FlightModels::default()),
        (None, 0, flights) => Err(Error::invalid_param(format!(
            "foresight_flights is {flights}, but a foresight needs surroundings; set surroundings_flights, too"
        ))),
        (None, flights, further) => {
            let compute = Compute::with_threads(threads);
            let surroundings = Arc::new(learn_surroundings(flights, params.seed, &compute, job.progress)?);
            let foresight = match further {
                0 => None,
                flights => {
                    let learnt = learn_foresight(flights, &surroundings, params.seed, threads, job.progress)?;
                    Some(Arc::new(learnt))
                }
            };
            Ok(FlightModels { surroundings: Some(surroundings), foresight })
        }
    }
}

impl LearnerRl for EndToEndPlanningRl {
    type FitParams = EndToEndPlanningFitParams;

    fn fit(
        base: Option<&Model>,
        params: &FlightParams,
        fit_params: &EndToEndPlanningFitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let models = SharedModels { known: Mutex::new(None), learn: &|| learn(base, fit_params, job) };
        let remembered = |source| MemorySource { source, models: &models };
        let (env, val_env) = (remembered(env), val_env.map(remembered));
        let val_env = val_env.as_ref().map(|source| source as &dyn EnvironmentSource);
        let (params, shield) = (params.to_map(), ShieldParams::default());
        let statistics =
            fit_policy::<PpoInCorridors>(base, &params, &shield, fit_params, &env, val_env, job)?;
        models.get()?.add_to(job)?;
        Ok(statistics)
    }
}
