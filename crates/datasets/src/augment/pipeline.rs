//! Sequences of augmentations.

use opendr_engine::dataset::Sample;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Random, Result, ResultExt};

use crate::augment::augmentation::check;
use crate::augment::{Augment, Augmentation, OtherSamples, find_augmentation};

/// Augmentations in the order in which they are applied, each with its probability.
///
/// ```
/// use opendr_datasets::augment::{Colour, Flip, Pipeline, RandomResizedCrop};
///
/// let pipeline = Pipeline::default()
///     .then(RandomResizedCrop { width: 416, height: 416, ..Default::default() })?
///     .sometimes(0.5, Flip::default())?
///     .sometimes(0.8, Colour::default())?;
/// assert_eq!(pipeline.names(), ["random_resized_crop", "flip", "colour"]);
/// # Ok::<(), opendr_engine::Error>(())
/// ```
#[derive(Default)]
pub struct Pipeline {
    steps: Vec<Step>,
}

struct Step {
    name: &'static str,
    probability: f32,
    augment: Box<dyn Augment>,
}

impl Pipeline {
    /// Adds `augmentation`, which is applied to every sample after the others.
    ///
    /// # Errors
    /// `InvalidParam` if a parameter is out of its range.
    pub fn then(self, augmentation: impl Augmentation) -> Result<Self> {
        self.sometimes(1.0, augmentation)
    }

    /// Adds `augmentation`, which is applied after the others with this probability.
    ///
    /// # Errors
    /// `InvalidParam` if the probability or a parameter is out of its range.
    pub fn sometimes<A: Augmentation>(self, probability: f32, augmentation: A) -> Result<Self> {
        check(&augmentation).context(|| A::NAME)?;
        self.push(A::NAME, probability, Box::new(augmentation))
    }

    /// Adds the augmentation `name` with parameters by name, as [`Pipeline::sometimes`].
    ///
    /// # Errors
    /// `NotFound` for an unknown augmentation, `InvalidParam` as above or for an unknown parameter.
    pub fn by_name(self, name: &str, probability: f32, params: &ParamMap) -> Result<Self> {
        let entry = find_augmentation(name)?;
        self.push(entry.name, probability, (entry.make)(params).context(|| entry.name)?)
    }

    /// Adds an augmentation that is not in the registry, as [`Pipeline::sometimes`].
    ///
    /// # Errors
    /// `InvalidParam` if the probability is not within 0 and 1.
    pub fn push(mut self, name: &'static str, probability: f32, augment: Box<dyn Augment>) -> Result<Self> {
        if !(0.0..=1.0).contains(&probability) {
            return Err(Error::invalid_param(format!(
                "{name}: the probability {probability} is not within 0 and 1"
            )));
        }
        self.steps.push(Step { name, probability, augment });
        Ok(self)
    }

    /// Returns the names of the augmentations in order.
    pub fn names(&self) -> Vec<&'static str> {
        self.steps.iter().map(|step| step.name).collect()
    }
}

impl Augment for Pipeline {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &OtherSamples<'_>) -> Result<()> {
        for step in &self.steps {
            if random.chance(step.probability) {
                step.augment
                    .apply(sample, random, others)
                    .context(|| format!("augmentation {}", step.name))?;
            }
        }
        Ok(())
    }
}
