//! Settings of policies that command a controller.

use opendr_engine::Result;
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, environment::Space};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{BoxedCommanded, Prior, PriorId};

/// Settings of a policy whose actions are commands to a prior, whatever trains it.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ShapingConfig {
    /// Name of the prior that follows the commands, in its newest version (`opendr sim priors` lists those with commands).
    #[param(default = "corridor-reactive".to_owned())]
    pub prior: String,
    /// Steps of the environment for which a command is held.
    #[param(default = 1, range = 1..=1000)]
    pub hold: u32,
    /// Logarithm of the initial standard deviation of the commands; policies of SAC have their own.
    #[param(default = -1.0, range = -20.0..=2.0)]
    pub command_log_std: f32,
}

impl ShapingConfig {
    /// Returns the controller that follows the commands, for observations of `space`.
    ///
    /// # Errors
    /// As [`Prior::newest`] and [`Prior::commanded`].
    pub fn controller(&self, space: &Space) -> Result<BoxedCommanded> {
        Prior::newest(&self.prior)?.commanded(space)
    }
}

/// Name and version of the commanded prior, and for how many steps it holds a command, in the inputs of a container's manifest.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct CommandRecord {
    #[serde(flatten)]
    pub id: PriorId,
    pub hold: u32,
}

const COMMANDED: &str = "commanded_prior";

impl CommandRecord {
    /// Returns the record of a container; none for a policy without one.
    ///
    /// # Errors
    /// `Format` for a damaged record.
    pub fn of(model: &Model) -> Result<Option<Self>> {
        let record = model.manifest().inputs.get(COMMANDED);
        record
            .map(Self::deserialize)
            .transpose()
            .map_err(|error| Error::format("the container's commanded prior is damaged").with_source(error))
    }

    /// Returns the entry of the manifest's inputs.
    ///
    /// # Errors
    /// `Internal` where the record has no JSON form.
    pub fn input(&self) -> Result<(&'static str, Value)> {
        let record = serde_json::to_value(self)
            .map_err(|error| Error::internal("a commanded prior has no JSON form").with_source(error))?;
        Ok((COMMANDED, record))
    }
}
