//! The priors of this process.

use std::sync::{PoisonError, RwLock};

use opendr_engine::{Error, Result};

use super::builtin::builtin;
use super::named_prior::{Prior, PriorId};

static REGISTERED: RwLock<Vec<Prior>> = RwLock::new(Vec::new());

impl Prior {
    /// Returns all priors of this process: the built-in ones, then those that were provided and registered.
    pub fn all() -> Vec<Self> {
        let registered = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
        [builtin(), registered.clone()].concat()
    }

    /// Makes the prior known to this process, so that policies trained on it load.
    ///
    /// # Errors
    /// `InvalidInput` where another of the same name and version is known.
    pub fn register(self) -> Result<()> {
        let mut registered = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        if builtin().iter().chain(registered.iter()).any(|prior| prior.id() == self.id()) {
            return Err(Error::invalid_input(format!(
                "the prior {} version {} is registered already; give the changed controller a new version",
                self.id().name,
                self.id().version
            )));
        }
        registered.push(self);
        Ok(())
    }

    /// Adds the priors of a crate above this one, as built-in ones; programs call [`Self::register`]. Where a program has registered one
    /// of the same name and version before, [`Self::find`] refuses both, since a policy may have been trained on either.
    pub fn provide(priors: Vec<Self>) {
        REGISTERED.write().unwrap_or_else(PoisonError::into_inner).extend(priors);
    }

    /// Returns the prior of this name and version.
    ///
    /// # Errors
    /// `NotFound` where this process has none; the message lists those that it has. `InvalidInput` where it has two.
    pub fn find(id: &PriorId) -> Result<Self> {
        let known = Self::all();
        let mut own = known.iter().filter(|prior| prior.id() == id);
        match (own.next(), own.next()) {
            (Some(prior), None) => Ok(prior.clone()),
            (None, _) => Err(not_found(id, &known)),
            (Some(_), Some(_)) => Err(Error::invalid_input(format!(
                "{} version {} is a prior of this toolkit and one that the program registered; give the program's another name",
                id.name, id.version
            ))),
        }
    }

    /// Returns the newest version of a prior.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn newest(name: &str) -> Result<Self> {
        let known = Self::all();
        let own = known.iter().map(Self::id).filter(|id| id.name == name);
        let newest = own.max_by_key(|id| id.version).cloned();
        Self::find(&newest.unwrap_or_else(|| PriorId { name: name.to_owned(), version: 1 }))
    }
}

fn not_found(id: &PriorId, known: &[Prior]) -> Error {
    let names = known.iter().map(|prior| format!("{} version {}", prior.id().name, prior.id().version));
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
    use opendr_engine::environment::Space;

    use super::*;
    use crate::prior::BoxedController;

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
        // One of the program and one that is provided later are two controllers: neither is taken silently.
        Prior::provide(vec![Prior::new("test-half", 4, make), Prior::new("test-half", 3, make)]);
        assert_eq!(Prior::newest("test-half").unwrap().id().version, 4);
        let id = PriorId { name: "test-half".to_owned(), version: 3 };
        assert_eq!(Prior::find(&id).err().unwrap().kind(), ErrorKind::InvalidInput);
        assert!(Prior::new("test-half", 4, make).register().is_err());
    }
}
