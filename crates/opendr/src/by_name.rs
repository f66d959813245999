//! Learners and models by name.

use std::path::PathBuf;

use opendr_engine::learner::AnyLearner;
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Progress, Result, Silent};
use opendr_zoo::{ModelFilter, ModelSummary, Zoo, ZooOptions};

use crate::registry;

/// Loads the learner that `spec` names (`"nanodet"`, `"yunet/320"`) with its pretrained model, on the best device.
///
/// The first call downloads the model into the cache.
///
/// # Errors
/// `NotFound` for an unknown name, else the error of the download or of loading.
pub fn learner(spec: &str) -> Result<Box<dyn AnyLearner>> {
    learner_with(spec, &ParamMap::new(), Device::Auto, &Silent)
}

/// As [`learner`], with parameters, a device, and a progress display for the download.
///
/// # Errors
/// As [`learner`], and `InvalidParam` for a wrong parameter.
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

/// Returns the path of the container of the pretrained model that `spec` names; the first call downloads it into the cache.
///
/// # Errors
/// `NotFound` for an unknown name, else the error of the download.
pub fn download(spec: &str) -> Result<PathBuf> {
    zoo()?.get(spec, &Silent)
}

/// Returns the models of the zoo that pass the filter and whose learners this build contains.
pub fn models<'a>(zoo: &'a Zoo, filter: &ModelFilter) -> Vec<ModelSummary<'a>> {
    let mut models = zoo.models(filter);
    models.retain(|model| {
        let learner = model.model.split('/').next().unwrap_or_default();
        registry().find(learner).is_ok()
    });
    models
}

/// Returns the zoo with the options of the environment.
fn zoo() -> Result<Zoo> {
    Zoo::new(ZooOptions::from_env()?)
}

/// Returns the registry name with the variant of `spec`, whose learner may be given by class name.
fn model_spec(name: &str, spec: &str) -> String {
    match spec.split_once('/') {
        Some((_, variant)) => format!("{name}/{variant}"),
        None => name.to_owned(),
    }
}
