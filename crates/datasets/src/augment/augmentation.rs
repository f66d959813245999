//! What an augmentation is.

use opendr_engine::dataset::Sample;
use opendr_engine::params::{Field, ParamMap, Params};
use opendr_engine::{Error, Random, Result};

use crate::augment::Others;

/// Changes samples at random.
pub trait Augment: Send + Sync {
    /// Changes `sample`, data and target together. All chance comes from `random`; `others` are the unchanged samples of
    /// the data set, for augmentations that mix several.
    ///
    /// # Errors
    /// `InvalidInput` when the sample has nothing that could be changed so; `Unsupported` when its target cannot follow;
    /// whatever reading another sample ends in. The sample is then of no use.
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &Others<'_>) -> Result<()>;
}

impl<A: Augment + ?Sized> Augment for Box<A> {
    fn apply(&self, sample: &mut Sample, random: &mut Random, others: &Others<'_>) -> Result<()> {
        (**self).apply(sample, random, others)
    }
}

/// An augmentation with a name and parameters, for surfaces to offer.
pub trait Augmentation: Augment + Params {
    /// The name, as users write it, e.g. `"random_crop"`.
    const NAME: &'static str;
    /// In one line.
    const ABOUT: &'static str;
}

/// One augmentation without its type.
pub struct AugmentEntry {
    /// As [`Augmentation::NAME`].
    pub name: &'static str,
    /// As [`Augmentation::ABOUT`].
    pub about: &'static str,
    /// Its parameters.
    pub fields: &'static [Field],
    /// Makes it; the defaults stand where `params` say nothing. `InvalidParam` for what does not fit.
    pub make: fn(params: &ParamMap) -> Result<Box<dyn Augment>>,
}

impl AugmentEntry {
    /// The entry of an augmentation.
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

/// Checks every parameter, and that no `min_...` is over its `max_...`.
pub(super) fn check<A: Augmentation>(augmentation: &A) -> Result<()> {
    augmentation.check()?;
    let params = augmentation.to_map();
    for (name, low) in &params {
        let high_name = name.strip_prefix("min_").map(|rest| format!("max_{rest}"));
        if let Some(high) = high_name.and_then(|high| params.get(&high))
            && low.as_float() > high.as_float()
        {
            return Err(Error::invalid_param(format!(
                "{name} = {low} is over its largest value, {high}; give less"
            )));
        }
    }
    Ok(())
}
