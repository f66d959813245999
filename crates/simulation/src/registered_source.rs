//! A registered environment with its parameters, as an environment source.

use opendr_engine::Result;
use opendr_engine::environment::{Environment, EnvironmentSource};
use opendr_engine::params::ParamMap;

use crate::registration::Registration;
use crate::registry::Registry;

/// Creates environments of one id and one set of parameters.
#[derive(Clone)]
pub struct RegisteredSource {
    registration: Registration,
    params: ParamMap,
}

impl RegisteredSource {
    /// Selects the built-in environment `id`, with `params` over its defaults.
    ///
    /// # Errors
    /// `NotFound` for an unknown id, `InvalidParam` for unknown parameters or values out of range.
    pub fn new(id: &str, params: &ParamMap) -> Result<Self> {
        let source = Self { registration: Registry::builtin().get(id)?.clone(), params: params.clone() };
        source.make()?;
        Ok(source)
    }

    /// Selects an environment that is not built in, such as a robot in another simulator. It is created by [`Self::make`] only.
    pub fn of(registration: Registration, params: &ParamMap) -> Self {
        Self { registration, params: params.clone() }
    }

    /// Returns name and version.
    pub fn id(&self) -> &str {
        self.registration.id()
    }

    /// Returns the parameters that differ from the defaults.
    pub fn params(&self) -> &ParamMap {
        &self.params
    }
}

impl EnvironmentSource for RegisteredSource {
    fn make(&self) -> Result<Box<dyn Environment>> {
        self.registration.make(&self.params)
    }
}
