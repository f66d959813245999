//! A prior controller with name and version.

use std::sync::Arc;

use opendr_engine::environment::{Controller, Space};
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

use super::BoxedCommanded;

/// A controller that can move between threads.
pub type BoxedController = Box<dyn Controller + Send>;

type Make = dyn Fn(&Space) -> Result<BoxedController> + Send + Sync;
type MakeCommanded = dyn Fn(&Space) -> Result<BoxedCommanded> + Send + Sync;

/// A controller that policies are trained on top of, under the name and version that their files carry. A change of its actions
/// needs a new version: a policy trained on other actions would act wrongly.
#[derive(Clone)]
pub struct Prior {
    id: PriorId,
    about: String,
    make: Arc<Make>,
    make_commanded: Option<Arc<MakeCommanded>>,
}

/// Name and version of a [`Prior`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PriorId {
    /// Name: `corridor-reactive`.
    pub name: String,
    /// Version, from 1.
    pub version: u32,
}

impl Prior {
    /// Creates a prior; `make` creates its controller for observations of a space.
    pub fn new(
        name: impl Into<String>,
        version: u32,
        make: impl Fn(&Space) -> Result<BoxedController> + Send + Sync + 'static,
    ) -> Self {
        let id = PriorId { name: name.into(), version };
        Self { id, about: String::new(), make: Arc::new(make), make_commanded: None }
    }

    /// Adds the same controller as one that follows commands, which policies of action shaping give; `make` creates it for observations
    /// of a space.
    #[must_use]
    pub fn with_commands(
        self,
        make: impl Fn(&Space) -> Result<BoxedCommanded> + Send + Sync + 'static,
    ) -> Self {
        Self { make_commanded: Some(Arc::new(make)), ..self }
    }

    /// Returns whether the controller follows commands.
    pub fn has_commands(&self) -> bool {
        self.make_commanded.is_some()
    }

    /// Creates the controller that follows commands, for observations of `space`.
    ///
    /// # Errors
    /// `Unsupported` for a prior without commands, and for a space that it does not read.
    pub fn commanded(&self, space: &Space) -> Result<BoxedCommanded> {
        let make = self.make_commanded.as_ref().ok_or_else(|| {
            Error::unsupported(format!(
                "the prior {} follows no commands; select one that \"opendr sim priors\" lists with commands, or correct it by residual_ppo",
                self.id.name
            ))
        })?;
        make(space)
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

    /// Returns the name and version.
    pub fn id(&self) -> &PriorId {
        &self.id
    }

    /// Creates a controller for observations of `space`.
    ///
    /// # Errors
    /// `Unsupported` for a space that the controller does not read.
    pub fn controller(&self, space: &Space) -> Result<BoxedController> {
        (self.make)(space)
    }
}

/// Returns the error of a prior that does not read observations of `space`.
#[cold]
pub fn unread_space(prior: &str, space: &Space) -> Error {
    Error::unsupported(format!(
        "{prior} reads no observations {space}; select a prior of this environment (\"opendr sim priors\" lists them)"
    ))
}
