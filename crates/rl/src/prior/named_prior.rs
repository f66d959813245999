//! A prior controller with name and version.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_engine::environment::{Controller, Space};
use serde::{Deserialize, Serialize};

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
}
