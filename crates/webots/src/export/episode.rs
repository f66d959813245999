//! The episode whose world is exported.

use opendr_engine::Result;
use opendr_engine::environment::{Environment, ResetOptions};
use opendr_engine::params::{ParamMap, Params};
use opendr_simulation::{RegisteredEnvironment, Registration};

/// An environment after its reset.
pub(super) struct Episode {
    pub id: String,
    pub seed: u64,
    pub observation: Vec<f32>,
    /// All parameters, with the defaults of the environment.
    params: ParamMap,
}

impl Episode {
    pub fn begin(registration: &Registration, params: &ParamMap, seed: u64) -> Result<Self> {
        let mut environment = registration.make(params)?;
        let mut observation = vec![0.0; environment.spec().observation.len()];
        environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
        let defaults =
            registration.fields().iter().map(|field| (field.name.to_owned(), field.default.value()));
        let mut all: ParamMap = defaults.collect();
        all.extend(params.iter().map(|(name, value)| (name.clone(), value.clone())));
        Ok(Self { id: registration.id().to_owned(), seed, observation, params: all })
    }

    /// Returns the parameters of type `P`; those that only a wrapper has, such as the form of the reward, are left out. All were checked
    /// when the episode began.
    pub fn params<P: Params>(&self) -> Result<P> {
        let has = |name: &str| P::FIELDS.iter().any(|field| field.is_called(name));
        let own = self.params.iter().filter(|(name, _)| has(name));
        P::from_map(&own.map(|(name, value)| (name.clone(), value.clone())).collect())
    }

    /// Returns the environment after the reset of the episode.
    pub fn environment<E: RegisteredEnvironment>(&self) -> Result<E> {
        let mut environment = E::new(&self.params::<E::Params>()?)?;
        self.reset(&mut environment)?;
        Ok(environment)
    }

    /// Begins the episode in another instance of the environment.
    pub fn reset(&self, environment: &mut impl Environment) -> Result<()> {
        let mut observation = vec![0.0; environment.spec().observation.len()];
        environment.reset(Some(self.seed), &ResetOptions::new(), &mut observation)?;
        Ok(())
    }

    /// Returns a number of the observation.
    pub fn number(&self, index: usize) -> f64 {
        self.observation.get(index).copied().map_or(0.0, f64::from)
    }
}
