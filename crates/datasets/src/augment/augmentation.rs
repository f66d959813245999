//! The traits of augmentations.

use opendr_engine::dataset::Sample;
use opendr_engine::params::{Field, ParamMap, Params};
use opendr_engine::{Error, Random, Result};

use crate::augment::OtherSamples;

/// Random change of samples.
pub trait Augment: Send + Sync {
    /// Changes `sample`, its data and target together. All randomness comes from `random`. `others` gives the
    /// unchanged samples of the data set, for augmentations that mix several.
    ///
    /// # Errors
    /// `InvalidInput` if the sample has no data of the type that is changed, `Unsupported` if its target cannot be
    /// changed accordingly, and errors of reading other samples. The sample is invalid after an error.
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &OtherSamples<'_>) -> Result<()>;
}

impl<A: Augment + ?Sized> Augment for Box<A> {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &OtherSamples<'_>) -> Result<()> {
        (**self).apply(sample, random, others)
    }
}

/// Augmentation with a name and parameters, which other languages and the command line offer.
pub trait Augmentation: Augment + Params {
    /// Name of the augmentation on the command line, e.g. `"random_crop"`.
    const NAME: &'static str;
    /// Description in one line.
    const ABOUT: &'static str;
}

/// An augmentation of the registry.
pub struct AugmentEntry {
    /// As [`Augmentation::NAME`].
    pub name: &'static str,
    /// As [`Augmentation::ABOUT`].
    pub about: &'static str,
    /// Its parameters.
    pub fields: &'static [Field],
    /// Creates the augmentation from parameters, with defaults for the missing ones; `InvalidParam` for an invalid
    /// parameter.
    pub make: fn(params: &ParamMap) -> Result<Box<dyn Augment>>,
}

impl AugmentEntry {
    /// Returns the entry of an augmentation.
    pub(super) const fn of<A: Augmentation>() -> Self {
        Self {
            name: A::NAME,
            about: A::ABOUT,
            fields: A::FIELDS,
            make: |params| {
                let augmentation = A::from_map(params)?;
                check(&augmentation)?;
                Ok(Box::new(augmentation))
            },
        }
    }
}

/// Checks every parameter, and that no `min_...` exceeds its `max_...`.
pub(super) fn check<A: Augmentation>(augmentation: &A) -> Result<()> {
    augmentation.check()?;
    let params = augmentation.to_map();
    for (name, low) in &params {
        let high_name = name.strip_prefix("min_").map(|rest| format!("max_{rest}"));
        if let Some(high) = high_name.and_then(|high| params.get(&high))
            && low.as_float() > high.as_float()
        {
            return Err(Error::invalid_param(format!(
                "{name} = {low} exceeds {high}, the upper limit; set it lower"
            )));
        }
    }
    Ok(())
}
