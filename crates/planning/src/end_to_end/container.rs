//! Surroundings in the container of a policy.

use std::sync::Arc;

use opendr_engine::learner::FitJob;
use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::{Error, Result};
use opendr_simulation::uav_corridor::Surroundings;

/// File of the surroundings in a container: little-endian f32 values.
const SURROUNDINGS: &str = "surroundings.f32";

/// Returns the surroundings of a container; none for a policy that was trained without them.
///
/// # Errors
/// `Format` for a damaged file.
pub fn surroundings_of(model: &Model) -> Result<Option<Arc<Surroundings>>> {
    if !model.manifest().files.iter().any(|file| file.name == SURROUNDINGS) {
        return Ok(None);
    }
    let bytes = model.file(SURROUNDINGS)?;
    let (numbers, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(Error::format(format!("{SURROUNDINGS} is cut off; train the policy again")));
    }
    let numbers = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Ok(Some(Arc::new(Surroundings::new(numbers)?)))
}

/// Adds the surroundings to the container written by a training.
pub(super) fn add_surroundings(surroundings: &Surroundings, job: &FitJob<'_>) -> Result<()> {
    let model = Model::open(job.model())?;
    let files = &model.manifest().files;
    let files = files.iter().map(|file| Ok((file.name.clone(), model.file(&file.name)?)));
    let files = files.collect::<Result<Vec<_>>>()?;
    let mut writer = ModelWriter::new(job.model(), model.manifest().clone())?;
    files.iter().try_for_each(|(name, bytes)| writer.add(name, bytes))?;
    let bytes = surroundings.parameters().iter().flat_map(|parameter| parameter.to_le_bytes());
    writer.add(SURROUNDINGS, &bytes.collect::<Vec<_>>())?;
    writer.finish().map(drop)
}
