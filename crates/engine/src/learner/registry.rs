//! The registry of learners.

use std::sync::{PoisonError, RwLock};

use crate::learner::any::Typed;
use crate::learner::capability::Abilities;
use crate::learner::{AnyLearner, Capabilities, Handle, Inputs, Learner, Output, Port, Spec, Targets};
use crate::params::{Field, ParamMap, Params};
use crate::{Device, Error, Result};

type Make = dyn Fn(&ParamMap, Device) -> Result<Box<dyn AnyLearner>> + Send + Sync;

/// A learner of a [`Registry`]: its tables and its constructor.
pub struct Entry {
    /// Name, task and class name.
    pub spec: Spec,
    /// Parameters of the inference.
    pub params: &'static [Field],
    /// Parameters of the training; empty if the learner does not train.
    pub fit_params: &'static [Field],
    /// Table of the inputs.
    pub ports: &'static [Port],
    /// Table of the outputs.
    pub outputs: &'static [Output],
    /// Whether streams have a state.
    pub stateful: bool,
    /// Optional capabilities.
    pub capabilities: Capabilities,
    make: Box<Make>,
}

impl Entry {
    /// Creates the entry of a compiled learner; `learners!` calls it.
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

    /// Creates the entry of a learner that is added at run time, from its tables and its constructor `make`.
    pub fn dynamic(
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

    /// Creates an empty learner; `params` override the defaults.
    ///
    /// # Errors
    /// Returns `InvalidParam` for an unknown parameter or an invalid value.
    pub fn make(&self, params: &ParamMap, device: Device) -> Result<Box<dyn AnyLearner>> {
        (self.make)(params, device)
    }
}

/// The learners of a program: compiled ones and those added at run time.
#[derive(Default)]
pub struct Registry {
    entries: RwLock<Vec<&'static Entry>>,
}

impl Registry {
    /// Creates a registry of `entries`; the macro [`learners!`](crate::learners) calls it.
    pub fn new(entries: Vec<Entry>) -> Self {
        let entries = entries.into_iter().map(|entry| &*Box::leak(Box::new(entry))).collect();
        Self { entries: RwLock::new(entries) }
    }

    /// Adds a learner for the lifetime of the process.
    ///
    /// # Errors
    /// Returns `InvalidParam` if there is a learner of that name.
    pub fn add(&self, entry: Entry) -> Result<()> {
        let mut entries = self.entries.write().unwrap_or_else(PoisonError::into_inner);
        if entries.iter().any(|other| other.spec.name == entry.spec.name) {
            return Err(Error::invalid_param(format!(
                "a learner {:?} is registered already; choose another name",
                entry.spec.name
            )));
        }
        entries.push(Box::leak(Box::new(entry)));
        Ok(())
    }

    /// Returns all learners, in order of registration.
    pub fn entries(&self) -> Vec<&'static Entry> {
        self.entries.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Returns the learner with this registry name or class name.
    ///
    /// # Errors
    /// Returns `NotFound` with the list of names if there is none.
    pub fn find(&self, name: &str) -> Result<&'static Entry> {
        let entries = self.entries();
        let found = entries.iter().find(|entry| entry.spec.name == name || entry.spec.class == name);
        found.copied().ok_or_else(|| {
            let names: Vec<_> = entries.iter().map(|entry| entry.spec.name).collect();
            Error::not_found(format!("no learner {name:?}; there are {}", names.join(", ")))
        })
    }
}

/// Creates a [`Registry`](crate::learner::Registry) of learner types, one per line. Learners may be grouped,
/// `#[cfg(feature = "stereo")] { SemiGlobalMatching }`, and each group may have attributes.
///
/// The capabilities of each learner follow from the traits that it implements.
#[macro_export]
macro_rules! learners {
    ($($(#[$attribute:meta])* { $($learner:ty),* $(,)? }),* $(,)?) => {{
        #[allow(unused_imports)]
        use $crate::learner::{
            Probe, ProbeFallback as _, ProbeFit as _, ProbeFitActive as _, ProbeFitIn as _,
            ProbeStreaming as _,
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
                    (&Probe::<$learner>::new()).fit_active(),
                ))
            ),*]);
        )*
        $crate::learner::Registry::new(entries)
    }};
    ($($learner:ty),* $(,)?) => { $crate::learners![{ $($learner),* }] };
}
