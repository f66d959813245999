//! Type-erased learners, for the surfaces.

use std::path::Path;

use crate::dataset::DatasetRef;
use crate::environment::EnvironmentSource;
use crate::learner::capability::{Abilities, PushFn};
use crate::learner::{Capabilities, FitJob, Handle, Learner, Outputs, Ports, Stream};
use crate::model::Model;
use crate::params::{ParamMap, ParamValue, Params};
use crate::target::Classes;
use crate::{Device, Error, Result, Statistics};

/// A [`Handle`] of any learner: one dynamic call per method, inputs and outputs by name.
pub trait AnyLearner: Send {
    /// Loads a model container.
    ///
    /// # Errors
    /// As [`Handle::load`].
    fn load(&mut self, path: &Path) -> Result<()>;

    /// Writes the model as a container.
    ///
    /// # Errors
    /// As [`Handle::save`].
    fn save(&self, path: &Path) -> Result<()>;

    /// Returns whether a model is loaded.
    fn is_ready(&self) -> bool;

    /// Predicts from named inputs, on the learner's own stream.
    ///
    /// # Errors
    /// As [`Stream::infer_ports`].
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs>;

    /// Processes the next piece of the own stream and passes each completed prediction to `emit`; `None` ends the stream.
    ///
    /// # Errors
    /// Returns `Unsupported` if the learner does not stream.
    fn push(&mut self, piece: Option<&Ports<'_>>, emit: &mut dyn FnMut(Outputs)) -> Result<()>;

    /// Trains on a data set, and loads the trained model.
    ///
    /// # Errors
    /// Returns `Unsupported` if the learner does not train.
    fn fit(
        &mut self,
        fit_params: &ParamMap,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;

    /// Trains in environments, and loads the trained model.
    ///
    /// # Errors
    /// Returns `Unsupported` if the learner is not a policy that trains.
    fn fit_in(
        &mut self,
        fit_params: &ParamMap,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let _ = (fit_params, env, val_env, job);
        Err(Error::unsupported("this learner cannot fit in an environment"))
    }

    /// Trains perception on a data set, or on views that the environments provide, and its motion in environments, and loads
    /// the trained model.
    ///
    /// # Errors
    /// Returns `Unsupported` if the learner is not one of active perception.
    fn fit_active(
        &mut self,
        fit_params: &ParamMap,
        dataset: Option<DatasetRef<'_>>,
        env: &dyn EnvironmentSource,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let _ = (fit_params, dataset, env, job);
        Err(Error::unsupported("this learner does not move a camera"))
    }

    /// Resets the state of the own stream.
    fn reset(&mut self);

    /// Creates another stream, for another camera, topic or thread.
    ///
    /// # Errors
    /// Returns `NotFound` if no model is loaded.
    fn stream(&self) -> Result<Box<dyn AnyStream>>;

    /// Returns the loaded container.
    fn model(&self) -> Option<&Model> {
        None
    }

    /// Returns the parameters.
    fn params(&self) -> ParamMap;

    /// Returns the default of a parameter.
    fn default_of(&self, name: &str) -> Option<ParamValue>;

    /// Sets a parameter.
    ///
    /// # Errors
    /// As [`Handle::set`].
    fn set(&mut self, name: &str, value: ParamValue) -> Result<()>;

    /// Returns the classes that the learner predicts.
    fn classes(&self) -> Classes;

    /// As [`Learner::metric_params`]; none before a model is loaded.
    fn metric_params(&self) -> ParamMap {
        ParamMap::new()
    }

    /// Returns the requested device.
    fn device(&self) -> Device;

    /// Returns the optional capabilities of the learner.
    fn capabilities(&self) -> Capabilities;
}

/// A [`Stream`] of any learner.
pub trait AnyStream: Send {
    /// Predicts from named inputs.
    ///
    /// # Errors
    /// As [`Stream::infer_ports`].
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs>;

    /// Processes the next piece and passes each completed prediction to `emit`; `None` ends the stream.
    ///
    /// # Errors
    /// Returns `Unsupported` if the learner does not stream.
    fn push(&mut self, piece: Option<&Ports<'_>>, emit: &mut dyn FnMut(Outputs)) -> Result<()>;

    /// Resets the state.
    fn reset(&mut self);
}

pub(crate) struct Typed<L: Learner> {
    pub(crate) handle: Handle<L>,
    pub(crate) abilities: Abilities<L>,
    pub(crate) target: L::Target,
}

struct TypedStream<L: Learner> {
    stream: Stream<L>,
    push: Option<PushFn<L>>,
    target: L::Target,
}

#[cold]
fn cannot<L: Learner>(what: &str) -> Error {
    Error::unsupported(format!("{} cannot {what}", L::SPEC.class))
}

impl<L: Learner> AnyLearner for Typed<L> {
    fn load(&mut self, path: &Path) -> Result<()> {
        self.handle.load(path)
    }

    fn save(&self, path: &Path) -> Result<()> {
        self.handle.save(path)
    }

    fn is_ready(&self) -> bool {
        self.handle.is_ready()
    }

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        self.handle.own_stream()?.infer_ports(ports, &mut self.target)?;
        Ok(Outputs::from_targets(&self.target))
    }

    fn push(&mut self, piece: Option<&Ports<'_>>, emit: &mut dyn FnMut(Outputs)) -> Result<()> {
        let push = self.abilities.push.ok_or_else(|| cannot::<L>("process its input in pieces"))?;
        push(self.handle.own_stream()?, piece, emit)
    }

    fn fit(
        &mut self,
        fit_params: &ParamMap,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let (fit, _) = self.abilities.fit.ok_or_else(|| cannot::<L>("fit a data set"))?;
        fit(&mut self.handle, fit_params, dataset, val_dataset, job)
    }

    fn fit_in(
        &mut self,
        fit_params: &ParamMap,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        if self.abilities.fit_active.is_some() && val_env.is_none() {
            return self.fit_active(fit_params, None, env, job);
        }
        let (fit, _) = self.abilities.fit_in.ok_or_else(|| cannot::<L>("fit in an environment"))?;
        fit(&mut self.handle, fit_params, env, val_env, job)
    }

    fn fit_active(
        &mut self,
        fit_params: &ParamMap,
        dataset: Option<DatasetRef<'_>>,
        env: &dyn EnvironmentSource,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let (fit, _) = self.abilities.fit_active.ok_or_else(|| cannot::<L>("move a camera"))?;
        fit(&mut self.handle, fit_params, dataset, env, job)
    }

    fn reset(&mut self) {
        self.handle.reset();
    }

    fn stream(&self) -> Result<Box<dyn AnyStream>> {
        let (stream, target) = (self.handle.stream()?, L::Target::default());
        Ok(Box::new(TypedStream { stream, push: self.abilities.push, target }))
    }

    fn model(&self) -> Option<&Model> {
        self.handle.model()
    }

    fn params(&self) -> ParamMap {
        self.handle.params().to_map()
    }

    fn default_of(&self, name: &str) -> Option<ParamValue> {
        self.handle.default_of(name)
    }

    fn set(&mut self, name: &str, value: ParamValue) -> Result<()> {
        self.handle.set(name, value)
    }

    fn classes(&self) -> Classes {
        self.handle.classes()
    }

    fn metric_params(&self) -> ParamMap {
        self.handle.metric_params()
    }

    fn device(&self) -> Device {
        self.handle.device()
    }

    fn capabilities(&self) -> Capabilities {
        self.abilities.capabilities()
    }
}

impl<L: Learner> AnyStream for TypedStream<L> {
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        self.stream.infer_ports(ports, &mut self.target)?;
        Ok(Outputs::from_targets(&self.target))
    }

    fn push(&mut self, piece: Option<&Ports<'_>>, emit: &mut dyn FnMut(Outputs)) -> Result<()> {
        let push = self.push.ok_or_else(|| cannot::<L>("process its input in pieces"))?;
        push(&mut self.stream, piece, emit)
    }

    fn reset(&mut self) {
        self.stream.reset();
    }
}
