//! A registered environment with its parameters, to be made as often as wanted.

use opendr_engine::Result;
use opendr_engine::environment::{Environment, EnvironmentSource};
use opendr_engine::params::ParamMap;

use crate::registry::{Registration, Registry};

/// What an id and parameters make.
#[derive(Clone)]
pub struct RegisteredSource {
    registration: Registration,
    params: ParamMap,
}

impl RegisteredSource {
    /// The built-in environment called `id`, with `params` over its defaults.
    ///
    /// # Errors
    /// `NotFound` for an unknown id, `InvalidParam` for parameters that it has not, or that are out of range.
    pub fn new(id: &str, params: &ParamMap) -> Result<Self> {
        let source = Self { registration: Registry::builtin().get(id)?.clone(), params: params.clone() };
        source.make()?;
        Ok(source)
    }

    /// Name and version.
    pub fn id(&self) -> &str {
        self.registration.id()
    }
}

impl EnvironmentSource for RegisteredSource {
    fn make(&self) -> Result<Box<dyn Environment>> {
        self.registration.make(&self.params)
    }
}
