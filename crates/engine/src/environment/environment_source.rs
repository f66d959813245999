//! Factories of environments.

use crate::Result;
use crate::environment::Environment;

/// A factory of environments of one kind: an id of a registry, or a constructor.
pub trait EnvironmentSource: Send + Sync {
    /// Creates an environment.
    ///
    /// # Errors
    /// Returns errors of the environment, and `Unsupported` if no more can be created.
    fn make(&self) -> Result<Box<dyn Environment>>;
}

/// Closures that create an environment are sources.
impl<F: Fn() -> Result<Box<dyn Environment>> + Send + Sync> EnvironmentSource for F {
    fn make(&self) -> Result<Box<dyn Environment>> {
        self()
    }
}
