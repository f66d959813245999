//! Adapted policies as models of their own.

use std::path::Path;

use opendr_engine::model::{Manifest, Model, ModelWriter, Sha256};
use opendr_engine::{Error, Result};
use opendr_rl::POLICY_FILE;
use serde::{Deserialize, Serialize};

use super::{NeuralPolicy, OnlineAdapter};

/// The file of a model that states how it was adapted.
pub const ADAPTATION: &str = "adaptation.json";

/// Lineage of an adapted policy: its base, the data it was adapted on, and the result. Saved as [`ADAPTATION`] in the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Adaptation {
    /// Checksum of the base policy's file.
    pub base: Sha256,
    /// What it was adapted on: the id of an environment, a robot, a recording.
    pub adapted_on: String,
    /// When, in seconds since 1970 (UTC).
    pub unix_time: u64,
    /// Control steps of the adaptation.
    pub steps: u64,
    /// Steps in which the parameters learned.
    pub updates: u64,
    /// Weights of the features, `[axes, features]`.
    pub weights: Vec<f32>,
}

impl OnlineAdapter<NeuralPolicy> {
    /// Saves the adapted policy as a new model at `path`, with its lineage. Nothing is ever replaced, so the base stays.
    ///
    /// # Errors
    /// `InvalidInput` when something is at `path`, `Io` when writing fails.
    pub fn save(&self, path: &Path, adapted_on: &str, unix_time: u64) -> Result<Model> {
        if path.exists() {
            return Err(Error::invalid_input(format!(
                "{} exists, and an adapted policy replaces nothing; name another place",
                path.display()
            )));
        }
        let [steps, updates] = self.steps();
        let base = Sha256::of(&self.base().policy().to_bytes()?);
        let adaptation = Adaptation {
            base,
            adapted_on: adapted_on.to_owned(),
            unix_time,
            steps,
            updates,
            weights: self.weights().to_vec(),
        };
        let mut manifest = Manifest::new("", "adapted");
        manifest.lineage.source = format!("policy {base}, adapted online on {adapted_on}");
        let unwritable = |error| Error::internal("an adaptation has no JSON form").with_source(error);
        let mut writer = ModelWriter::new(path, manifest)?;
        writer.add(POLICY_FILE, &self.adapted().policy().to_bytes()?)?;
        writer.add(ADAPTATION, &serde_json::to_vec_pretty(&adaptation).map_err(unwritable)?)?;
        writer.add("events.json", &serde_json::to_vec_pretty(self.log()).map_err(unwritable)?)?;
        writer.finish()
    }

    /// Goes on from the adapted policy of a model that [`Self::save`] wrote.
    ///
    /// # Errors
    /// `InvalidInput` when it was adapted from another base, else as [`Model::file`].
    pub fn load(&mut self, model: &Model) -> Result<Adaptation> {
        let adaptation: Adaptation = serde_json::from_slice(&model.file(ADAPTATION)?)
            .map_err(|error| Error::format(format!("{ADAPTATION} does not fit")).with_source(error))?;
        let own = Sha256::of(&self.base().policy().to_bytes()?);
        if adaptation.base != own {
            return Err(Error::invalid_input(format!(
                "the model was adapted from the policy {}, and this one is {own}; load it on its own base",
                adaptation.base
            )));
        }
        self.restore_weights(&adaptation.weights)?;
        Ok(adaptation)
    }
}
