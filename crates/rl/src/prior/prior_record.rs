//! The prior of a policy in its container.

use opendr_engine::model::Model;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::PriorId;

/// Name, version and factor of the corrections, in the inputs of a container's manifest.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PriorRecord {
    #[serde(flatten)]
    pub id: PriorId,
    pub alpha: f32,
}

const PRIOR: &str = "prior";

impl PriorRecord {
    /// Returns the record of a container; none for a policy without a prior.
    ///
    /// # Errors
    /// `Format` for a damaged record.
    pub fn of(model: &Model) -> Result<Option<Self>> {
        let record = model.manifest().inputs.get(PRIOR);
        record
            .map(Self::deserialize)
            .transpose()
            .map_err(|error| Error::format("the container's prior is damaged").with_source(error))
    }

    /// Returns the entry of the manifest's inputs.
    ///
    /// # Errors
    /// `Internal` where the record has no JSON form.
    pub fn input(&self) -> Result<(&'static str, Value)> {
        let record = serde_json::to_value(self)
            .map_err(|error| Error::internal("a prior has no JSON form").with_source(error))?;
        Ok((PRIOR, record))
    }
}
