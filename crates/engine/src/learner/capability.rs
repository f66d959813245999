//! Optional capabilities of learners, detected at compile time.

use std::marker::PhantomData;

use crate::dataset::DatasetRef;
use crate::environment::EnvironmentSource;
use crate::learner::{
    Fit, FitJob, Handle, Learner, LearnerActive, LearnerRl, Outputs, Ports, Stream, Streaming,
};
use crate::params::{Field, ParamMap, Params};
use crate::{Result, Statistics};

/// Optional capabilities of a learner. A call of a missing one returns `Unsupported`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Capabilities {
    /// Whether `fit` trains on a data set.
    pub fit: bool,
    /// Whether `fit_in` trains in an environment.
    pub fit_in: bool,
    /// Whether `push` and `flush` process the input in pieces.
    pub streaming: bool,
}

pub(crate) type PushFn<L> = fn(&mut Stream<L>, Option<&Ports<'_>>, &mut dyn FnMut(Outputs)) -> Result<()>;
pub(crate) type FitFn<L> =
    fn(&mut Handle<L>, &ParamMap, DatasetRef<'_>, Option<DatasetRef<'_>>, &FitJob<'_>) -> Result<Statistics>;
pub(crate) type FitInFn<L> = fn(
    &mut Handle<L>,
    &ParamMap,
    &dyn EnvironmentSource,
    Option<&dyn EnvironmentSource>,
    &FitJob<'_>,
) -> Result<Statistics>;
pub(crate) type FitActiveFn<L> = fn(
    &mut Handle<L>,
    &ParamMap,
    Option<DatasetRef<'_>>,
    &dyn EnvironmentSource,
    &FitJob<'_>,
) -> Result<Statistics>;

/// The optional capabilities of `L` as plain functions.
#[doc(hidden)]
pub struct Abilities<L: Learner> {
    pub(crate) push: Option<PushFn<L>>,
    pub(crate) fit: Option<(FitFn<L>, &'static [Field])>,
    pub(crate) fit_in: Option<(FitInFn<L>, &'static [Field])>,
    pub(crate) fit_active: Option<(FitActiveFn<L>, &'static [Field])>,
}

impl<L: Learner> Clone for Abilities<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Learner> Copy for Abilities<L> {}

impl<L: Learner> Abilities<L> {
    pub(crate) fn capabilities(&self) -> Capabilities {
        Capabilities {
            fit: self.fit.is_some(),
            fit_in: self.fit_in.is_some() || self.fit_active.is_some(),
            streaming: self.push.is_some(),
        }
    }

    /// Returns the parameters of the training.
    pub(crate) fn fit_fields(&self) -> &'static [Field] {
        let fields = self.fit.map(|(_, fields)| fields);
        let fields = fields.or(self.fit_in.map(|(_, fields)| fields));
        fields.or(self.fit_active.map(|(_, fields)| fields)).unwrap_or(&[])
    }
}

/// Detects whether `L` implements an optional trait.
///
/// `(&Probe::<L>::new()).push()` resolves to [`ProbeStreaming`] if `L: Streaming`, and otherwise, one reference further,
/// to [`ProbeFallback`]. This needs the concrete types that `learners!` names. A learner therefore declares a capability
/// by implementing the trait and nowhere else.
#[doc(hidden)]
pub struct Probe<L>(PhantomData<L>);

impl<L> Probe<L> {
    #[allow(clippy::new_without_default, missing_docs)]
    pub const fn new() -> Self {
        Self(PhantomData)
    }

    #[allow(missing_docs)]
    pub fn abilities(
        push: Option<PushFn<L>>,
        fit: Option<(FitFn<L>, &'static [Field])>,
        fit_in: Option<(FitInFn<L>, &'static [Field])>,
        fit_active: Option<(FitActiveFn<L>, &'static [Field])>,
    ) -> Abilities<L>
    where
        L: Learner,
    {
        Abilities { push, fit, fit_in, fit_active }
    }
}

#[doc(hidden)]
#[allow(missing_docs)]
pub trait ProbeFallback<L: Learner> {
    fn push(&self) -> Option<PushFn<L>> {
        None
    }

    fn fit(&self) -> Option<(FitFn<L>, &'static [Field])> {
        None
    }

    fn fit_in(&self) -> Option<(FitInFn<L>, &'static [Field])> {
        None
    }

    fn fit_active(&self) -> Option<(FitActiveFn<L>, &'static [Field])> {
        None
    }
}

impl<L: Learner> ProbeFallback<L> for &Probe<L> {}

#[doc(hidden)]
#[allow(missing_docs)]
pub trait ProbeStreaming<L: Learner> {
    fn push(&self) -> Option<PushFn<L>>;
}

impl<L: Streaming> ProbeStreaming<L> for Probe<L> {
    fn push(&self) -> Option<PushFn<L>> {
        Some(|stream, piece, emit| stream.push_ports(piece, emit))
    }
}

#[doc(hidden)]
#[allow(missing_docs)]
pub trait ProbeFit<L: Learner> {
    fn fit(&self) -> Option<(FitFn<L>, &'static [Field])>;
}

impl<L: Fit> ProbeFit<L> for Probe<L> {
    fn fit(&self) -> Option<(FitFn<L>, &'static [Field])> {
        Some((
            |handle, map, dataset, val_dataset, job| {
                handle.fit(&L::FitParams::from_map(map)?, dataset, val_dataset, job)
            },
            L::FitParams::FIELDS,
        ))
    }
}

#[doc(hidden)]
#[allow(missing_docs)]
pub trait ProbeFitIn<L: LearnerRl> {
    fn fit_in(&self) -> Option<(FitInFn<L>, &'static [Field])>;
}

impl<L: LearnerRl> ProbeFitIn<L> for Probe<L> {
    fn fit_in(&self) -> Option<(FitInFn<L>, &'static [Field])> {
        Some((
            |handle, map, env, val_env, job| handle.fit_in(&L::FitParams::from_map(map)?, env, val_env, job),
            L::FitParams::FIELDS,
        ))
    }
}

#[doc(hidden)]
#[allow(missing_docs)]
pub trait ProbeFitActive<L: LearnerActive> {
    fn fit_active(&self) -> Option<(FitActiveFn<L>, &'static [Field])>;
}

impl<L: LearnerActive> ProbeFitActive<L> for Probe<L> {
    fn fit_active(&self) -> Option<(FitActiveFn<L>, &'static [Field])> {
        Some((
            |handle, map, dataset, env, job| {
                handle.fit_active(&L::FitParams::from_map(map)?, dataset, env, job)
            },
            L::FitParams::FIELDS,
        ))
    }
}
