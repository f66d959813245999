//! Where a policy's environments come from.

use crate::Result;
use crate::environment::Environment;

/// Makes environments of one kind, as many as a training wants: an id of a registry, a constructor of a program.
pub trait EnvironmentSource: Send + Sync {
    /// Makes one.
    ///
    /// # Errors
    /// Those of the environment, and `Unsupported` where no further one can be made.
    fn make(&self) -> Result<Box<dyn Environment>>;
}

/// A constructor is a source.
impl<F: Fn() -> Result<Box<dyn Environment>> + Send + Sync> EnvironmentSource for F {
    fn make(&self) -> Result<Box<dyn Environment>> {
        self()
    }
}
