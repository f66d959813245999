//! Learners and models by name.

use std::path::PathBuf;

use opendr_engine::learner::AnyLearner;
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Progress, Result, Silent};
use opendr_zoo::{Zoo, ZooOptions};

use crate::registry;

/// The learner that `spec` names (`"nanodet"`, `"yunet/320"`), with its pretrained model, on the best device.
///
/// The model is downloaded into the cache the first time.
///
/// # Errors
/// `NotFound` for a name that there is not, else what kept the model from being got or loaded.
pub fn learner(spec: &str) -> Result<Box<dyn AnyLearner>> {
    learner_with(spec, &ParamMap::new(), Device::Auto, &Silent)
}

/// As [`learner`], with parameters, a device, and someone to tell how the download goes.
///
/// # Errors
/// As [`learner`], and `InvalidParam` for a parameter that does not fit.
pub fn learner_with(
    spec: &str,
    params: &ParamMap,
    device: Device,
    progress: &dyn Progress,
) -> Result<Box<dyn AnyLearner>> {
    let entry = registry().find(spec.split('/').next().unwrap_or(spec))?;
    let mut learner = entry.make(params, device)?;
    learner.load(&zoo()?.get(&model_spec(entry.spec.name, spec), progress)?)?;
    Ok(learner)
}

/// The container of the pretrained model that `spec` names, downloaded into the cache the first time.
///
/// # Errors
/// `NotFound` for a name that there is not, else what kept the model from being got.
pub fn download(spec: &str) -> Result<PathBuf> {
    zoo()?.get(spec, &Silent)
}

/// The zoo as the environment sets it up.
fn zoo() -> Result<Zoo> {
    Zoo::new(ZooOptions::from_env()?)
}

/// The registry name with the variant of `spec`, whose first half may be a class name.
fn model_spec(name: &str, spec: &str) -> String {
    match spec.split_once('/') {
        Some((_, variant)) => format!("{name}/{variant}"),
        None => name.to_owned(),
    }
}
