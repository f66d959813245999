//! Which learners there are.

use std::sync::{PoisonError, RwLock};

use crate::learner::any::Typed;
use crate::learner::capability::Abilities;
use crate::learner::{AnyLearner, Capabilities, Handle, Inputs, Learner, Output, Port, Spec, Targets};
use crate::params::{Field, ParamMap, Params};
use crate::{Device, Error, Result};

type Make = dyn Fn(&ParamMap, Device) -> Result<Box<dyn AnyLearner>> + Send + Sync;

/// One learner of a [`Registry`]: its tables, and how to make one.
pub struct Entry {
    /// Name, task, class.
    pub spec: Spec,
    /// The parameters of `infer`.
    pub params: &'static [Field],
    /// The parameters of `fit`; empty when it does not train.
    pub fit_params: &'static [Field],
    /// What it takes.
    pub ports: &'static [Port],
    /// What it answers.
    pub outputs: &'static [Output],
    /// Whether a stream remembers anything.
    pub stateful: bool,
    /// What it can do besides `infer`.
    pub capabilities: Capabilities,
    make: Box<Make>,
}

impl Entry {
    /// The entry of a compiled learner; `learners!` calls it.
    #[doc(hidden)]
    pub fn of<L: Learner>(abilities: Abilities<L>) -> Self {
        Self {
            spec: L::SPEC,
            params: L::Params::FIELDS,
            fit_params: abilities.fit_fields(),
            ports: <L::Input<'static> as Inputs<'static>>::PORTS,
            outputs: L::Target::OUTPUTS,
            stateful: size_of::<L::State>() > 0,
            capabilities: abilities.capabilities(),
            make: Box::new(move |params, device| {
                let handle = Handle::<L>::new(L::Params::from_map(params)?, device)?;
                Ok(Box::new(Typed { handle, abilities, target: L::Target::default() }))
            }),
        }
    }

    /// The entry of a learner that is not compiled in: `make` builds it, the tables say what it takes and answers.
    pub fn added(
        spec: Spec,
        params: &'static [Field],
        ports: &'static [Port],
        outputs: &'static [Output],
        make: impl Fn(&ParamMap, Device) -> Result<Box<dyn AnyLearner>> + Send + Sync + 'static,
    ) -> Self {
        let capabilities = Capabilities::default();
        Self {
            spec,
            params,
            fit_params: &[],
            ports,
            outputs,
            stateful: true,
            capabilities,
            make: Box::new(make),
        }
    }

    /// An empty learner with `params` over the defaults.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown or wrong parameter.
    pub fn make(&self, params: &ParamMap, device: Device) -> Result<Box<dyn AnyLearner>> {
        (self.make)(params, device)
    }
}

/// The learners of a program: those compiled in, and those added at run time.
#[derive(Default)]
pub struct Registry {
    entries: RwLock<Vec<&'static Entry>>,
}

impl Registry {
    /// A registry of `entries`; write it with [`learners!`](crate::learners).
    pub fn new(entries: Vec<Entry>) -> Self {
        let entries = entries.into_iter().map(|entry| &*Box::leak(Box::new(entry))).collect();
        Self { entries: RwLock::new(entries) }
    }

    /// Adds a learner; it stays for the life of the process.
    ///
    /// # Errors
    /// `InvalidParam` when the name is taken.
    pub fn add(&self, entry: Entry) -> Result<()> {
        let mut entries = self.entries.write().unwrap_or_else(PoisonError::into_inner);
        if entries.iter().any(|other| other.spec.name == entry.spec.name) {
            return Err(Error::invalid_param(format!("there is a learner {:?} already", entry.spec.name)));
        }
        entries.push(Box::leak(Box::new(entry)));
        Ok(())
    }

    /// Every learner, in order of registration.
    pub fn entries(&self) -> Vec<&'static Entry> {
        self.entries.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The learner called `name`, by its registry name or class name.
    ///
    /// # Errors
    /// `NotFound`, with the names that there are.
    pub fn find(&self, name: &str) -> Result<&'static Entry> {
        let entries = self.entries();
        let found = entries.iter().find(|entry| entry.spec.name == name || entry.spec.class == name);
        found.copied().ok_or_else(|| {
            let names: Vec<_> = entries.iter().map(|entry| entry.spec.name).collect();
            Error::not_found(format!("no learner {name:?}; there are {}", names.join(", ")))
        })
    }
}

/// Makes a [`Registry`](crate::learner::Registry) of learner types: one line a learner. Learners may stand in groups,
/// `#[cfg(feature = "stereo")] { SemiGlobalMatching }`, each compiled in or not.
///
/// What each can do besides `infer` follows from the traits that it implements.
#[macro_export]
macro_rules! learners {
    ($($(#[$attribute:meta])* { $($learner:ty),* $(,)? }),* $(,)?) => {{
        #[allow(unused_imports)]
        use $crate::learner::{
            Probe, ProbeFallback as _, ProbeFit as _, ProbeFitIn as _, ProbeStreaming as _,
        };
        #[allow(unused_mut)]
        let mut entries = Vec::<$crate::learner::Entry>::new();
        $(
            $(#[$attribute])*
            entries.extend([$(
                $crate::learner::Entry::of::<$learner>(Probe::<$learner>::abilities(
                    (&Probe::<$learner>::new()).push(),
                    (&Probe::<$learner>::new()).fit(),
                    (&Probe::<$learner>::new()).fit_in(),
                ))
            ),*]);
        )*
        $crate::learner::Registry::new(entries)
    }};
    ($($learner:ty),* $(,)?) => { $crate::learners![{ $($learner),* }] };
}
