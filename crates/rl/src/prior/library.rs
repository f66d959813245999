//! Priors by name and version.

use std::sync::{Arc, PoisonError, RwLock};

use opendr_engine::environment::{Controller, Space};
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

use super::builtin::builtin;

/// A controller that can move between threads.
pub type BoxedController = Box<dyn Controller + Send>;

type Make = dyn Fn(&Space) -> Result<BoxedController> + Send + Sync;

/// A controller that policies are trained on top of, under the name and version that their files carry. A change of its actions
/// needs a new version: a policy trained on other actions would act wrongly.
#[derive(Clone)]
pub struct Prior {
    id: PriorId,
    about: String,
    make: Arc<Make>,
}

/// Name and version of a [`Prior`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PriorId {
    /// Name: `corridor-reactive`.
    pub name: String,
    /// Version, from 1.
    pub version: u32,
}

static REGISTERED: RwLock<Vec<Prior>> = RwLock::new(Vec::new());

impl Prior {
    /// A prior; `make` creates its controller for observations of a space.
    pub fn new(
        name: impl Into<String>,
        version: u32,
        make: impl Fn(&Space) -> Result<BoxedController> + Send + Sync + 'static,
    ) -> Self {
        Self { id: PriorId { name: name.into(), version }, about: String::new(), make: Arc::new(make) }
    }

    /// Adds what the controller does and where, in one sentence.
    #[must_use]
    pub fn about(self, about: impl Into<String>) -> Self {
        Self { about: about.into(), ..self }
    }

    /// Returns what the controller does and where; empty if not stated.
    pub fn description(&self) -> &str {
        &self.about
    }

    /// Returns all priors of this process: the built-in ones, then those that were registered.
    pub fn all() -> Vec<Self> {
        let registered = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
        [builtin(), registered.clone()].concat()
    }

    /// Name and version.
    pub fn id(&self) -> &PriorId {
        &self.id
    }

    /// A controller for observations of `space`.
    ///
    /// # Errors
    /// `Unsupported` for a space that the controller does not read.
    pub fn controller(&self, space: &Space) -> Result<BoxedController> {
        (self.make)(space)
    }

    /// Makes the prior known to this process, so that policies trained on it load.
    ///
    /// # Errors
    /// `InvalidInput` where another of the same name and version is known.
    pub fn register(self) -> Result<()> {
        let mut registered = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        if builtin().iter().chain(registered.iter()).any(|prior| prior.id == self.id) {
            return Err(Error::invalid_input(format!(
                "the prior {} version {} is registered already; give the changed controller a new version",
                self.id.name, self.id.version
            )));
        }
        registered.push(self);
        Ok(())
    }

    /// The prior of this name and version.
    ///
    /// # Errors
    /// `NotFound` where this process has none; the message lists those that it has.
    pub fn find(id: &PriorId) -> Result<Self> {
        let known = Self::all();
        known.iter().find(|prior| prior.id == *id).cloned().ok_or_else(|| not_found(id, &known))
    }

    /// The newest version of a prior.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn newest(name: &str) -> Result<Self> {
        let known = Self::all();
        let own = known.iter().filter(|prior| prior.id.name == name);
        let newest = own.max_by_key(|prior| prior.id.version).cloned();
        newest.ok_or_else(|| not_found(&PriorId { name: name.to_owned(), version: 1 }, &known))
    }
}

fn not_found(id: &PriorId, known: &[Prior]) -> Error {
    let names = known.iter().map(|prior| format!("{} version {}", prior.id.name, prior.id.version));
    Error::not_found(format!(
        "this program has no prior {} version {}, only {}; register it with Prior::register before the policy is loaded",
        id.name,
        id.version,
        names.collect::<Vec<_>>().join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn an_unknown_prior_is_an_error() {
        let id = PriorId { name: "corridor-reactive".to_owned(), version: 9 };
        let error = Prior::find(&id).err().unwrap();
        assert_eq!(error.kind(), ErrorKind::NotFound);
        assert!(error.to_string().contains("corridor-reactive version 1"), "{error}");
        let make = |_: &Space| -> Result<BoxedController> {
            Ok(Box::new(|_: &[f32], action: &mut [f32]| {
                action.fill(0.5);
                Ok(())
            }))
        };
        Prior::new("test-half", 3, make).register().unwrap();
        assert!(Prior::new("test-half", 3, make).register().is_err());
        assert_eq!(Prior::newest("test-half").unwrap().id().version, 3);
    }
}
