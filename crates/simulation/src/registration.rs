//! Entries of the registry of environments.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_engine::environment::Environment;
use opendr_engine::params::{Field, ParamMap, Params};

use crate::classic_control::{CartPole, CartPoleParams};
use crate::vector::{CartPoleVector, EnvironmentVector, VecEnvironment, VectorOptions};
use crate::wrappers::{Checked, TimeLimit};

/// An environment that can be registered.
pub trait RegisteredEnvironment: Environment + Sized + 'static {
    /// Name and version, such as `CartPole-v1`.
    const ID: &'static str;
    /// Parameters of the environment.
    type Params: Params;

    /// Creates the environment.
    ///
    /// # Errors
    /// `InvalidParam` for a parameter out of range.
    fn new(params: &Self::Params) -> Result<Self>;
}

type Make = dyn Fn(&ParamMap) -> Result<Box<dyn Environment>> + Send + Sync;

/// An entry of a [`Registry`](crate::Registry).
#[derive(Clone)]
pub struct Registration {
    pub(crate) id: String,
    fields: &'static [Field],
    make: Arc<Make>,
}

impl Registration {
    /// Creates an entry for an environment type. It is created with its time limit and wrapped in [`Checked`].
    pub fn of<E: RegisteredEnvironment>() -> Self {
        Self::new(E::ID, E::Params::FIELDS, |params| checked(E::new(&E::Params::from_map(params)?)?))
    }

    /// Creates an entry for the environments that `make` returns.
    pub fn new(
        id: &str,
        fields: &'static [Field],
        make: impl Fn(&ParamMap) -> Result<Box<dyn Environment>> + Send + Sync + 'static,
    ) -> Self {
        Self { id: id.to_owned(), fields, make: Arc::new(make) }
    }

    /// Returns name and version.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Returns the fields of its parameters.
    pub fn fields(&self) -> &'static [Field] {
        self.fields
    }

    /// Creates the environment.
    ///
    /// # Errors
    /// `InvalidParam` for unknown parameters or values out of range.
    pub fn make(&self, params: &ParamMap) -> Result<Box<dyn Environment>> {
        (self.make)(params).map_err(|error| error.context(format!("creating {}", self.id)))
    }

    /// Creates `options.count` environments that are stepped together.
    ///
    /// # Errors
    /// As [`Self::make`], and `InvalidParam` for a count of 0 or too many.
    pub fn make_vec(&self, params: &ParamMap, options: VectorOptions) -> Result<Box<dyn VecEnvironment>> {
        if self.id == <CartPole as RegisteredEnvironment>::ID {
            let carts = CartPoleParams::from_map(params)
                .and_then(|params| CartPoleVector::new(&params, options.count, options.autoreset));
            return Ok(Box::new(carts.map_err(|error| error.context(format!("creating {}", self.id)))?));
        }
        let environments = (0..options.checked_count()?).map(|_| self.make(params));
        let environments = environments.collect::<Result<Vec<_>>>()?;
        Ok(Box::new(EnvironmentVector::new(environments, options.autoreset, options.threads)?))
    }
}

/// Wraps an environment in the time limit of its spec and in checks.
pub(crate) fn checked(environment: impl Environment + 'static) -> Result<Box<dyn Environment>> {
    Ok(match environment.spec().max_episode_steps {
        Some(limit) => Box::new(Checked::new(TimeLimit::new(environment, limit)?)),
        None => Box::new(Checked::new(environment)),
    })
}
