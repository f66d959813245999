//! Training of end-to-end planning: surroundings first, then the policy.

use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::environment::{Environment, EnvironmentSource};
use opendr_engine::learner::{FitJob, LearnerRl};
use opendr_engine::model::Model;
use opendr_engine::params::Params as _;
use opendr_engine::{Result, Statistics};
use opendr_kernels::Compute;
use opendr_rl::fit_policy;
use opendr_rl::prior::ShieldParams;
use opendr_simulation::uav_corridor::{FlightMemoryWrapper, Surroundings};

use super::container::{add_surroundings, surroundings_of};
use super::method::{EndToEndPlanningFitParams, PpoInCorridors};
use super::surroundings::learn_surroundings;
use super::{EndToEndPlanningRl, FlightParams};

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
        let statistics = fit_policy::<PpoInCorridors>(
            base,
            &params.to_map(),
            &ShieldParams::default(),
            fit_params,
            &env,
            val_env,
            job,
        )?;
        if let Some(surroundings) = surroundings.get()? {
            add_surroundings(&surroundings, job)?;
        }
        Ok(statistics)
    }
}
