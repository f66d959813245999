//! What the proposals of a flight have learnt, in the container of a policy.

use std::sync::Arc;

use opendr_engine::learner::FitJob;
use opendr_engine::model::{Model, ModelWriter};
use opendr_engine::{Error, Result};
use opendr_simulation::uav_corridor::{FlightMemory, FlightMemoryWrapper, Foresight, Surroundings};

/// Files in a container: little-endian f32 values.
const SURROUNDINGS: &str = "surroundings.f32";
const FORESIGHT: &str = "foresight.f32";

/// The learnt models behind the proposals of a flight; none for a policy that was trained without them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FlightModels {
    /// Costs of cells that the camera has not observed.
    pub surroundings: Option<Arc<Surroundings>>,
    /// How flights end after each possible step; it needs the surroundings.
    pub foresight: Option<Arc<Foresight>>,
}

impl FlightModels {
    /// Returns the models of a container.
    ///
    /// # Errors
    /// `Format` for a damaged file, or a foresight without surroundings.
    pub fn of(model: &Model) -> Result<Self> {
        let surroundings = numbers_of(model, SURROUNDINGS)?.map(Surroundings::new).transpose()?.map(Arc::new);
        let foresight = numbers_of(model, FORESIGHT)?.map(Foresight::new).transpose()?.map(Arc::new);
        match (&surroundings, &foresight) {
            (None, Some(_)) => {
                Err(Error::format(format!("{FORESIGHT} without {SURROUNDINGS}; train the policy again")))
            }
            _ => Ok(Self { surroundings, foresight }),
        }
    }

    /// Returns a memory of flights that proposes by these models.
    pub fn memory(&self) -> FlightMemory {
        let mut memory = FlightMemory::default();
        if let Some(surroundings) = &self.surroundings {
            memory = memory.with_surroundings(Arc::clone(surroundings));
        }
        if let Some(foresight) = &self.foresight {
            memory = memory.with_foresight(Arc::clone(foresight));
        }
        memory
    }

    /// Makes a wrapped corridor propose by these models.
    #[must_use]
    pub fn propose_in<E: opendr_engine::environment::Environment>(
        &self,
        corridor: FlightMemoryWrapper<E>,
    ) -> FlightMemoryWrapper<E> {
        corridor.with_memory(self.memory())
    }

    /// Adds the models to the container written by a training.
    ///
    /// # Errors
    /// `Io` when the container cannot be written.
    pub(super) fn add_to(&self, job: &FitJob<'_>) -> Result<()> {
        if *self == Self::default() {
            return Ok(());
        }
        let model = Model::open(job.model())?;
        let files = &model.manifest().files;
        let files = files.iter().map(|file| Ok((file.name.clone(), model.file(&file.name)?)));
        let files = files.collect::<Result<Vec<_>>>()?;
        let mut writer = ModelWriter::new(job.model(), model.manifest().clone())?;
        files.iter().try_for_each(|(name, bytes)| writer.add(name, bytes))?;
        let learnt = [
            (SURROUNDINGS, self.surroundings.as_ref().map(|learnt| learnt.parameters())),
            (FORESIGHT, self.foresight.as_ref().map(|learnt| learnt.parameters())),
        ];
        for (name, parameters) in learnt {
            let Some(parameters) = parameters else { continue };
            let bytes: Vec<u8> = parameters.iter().flat_map(|parameter| parameter.to_le_bytes()).collect();
            writer.add(name, &bytes)?;
        }
        writer.finish().map(drop)
    }
}

/// Returns the numbers of a file; none if the container does not have it.
fn numbers_of(model: &Model, name: &str) -> Result<Option<Vec<f32>>> {
    if !model.manifest().files.iter().any(|file| file.name == name) {
        return Ok(None);
    }
    let bytes = model.file(name)?;
    let (numbers, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(Error::format(format!("{name} is cut off; train the policy again")));
    }
    Ok(Some(numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()))
}
