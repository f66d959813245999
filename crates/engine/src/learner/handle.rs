//! A learner as users hold it.

use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

use crate::learner::{Learner, Stream};
use crate::model::{Manifest, Model, ModelWriter};
use crate::params::{ParamMap, ParamValue, Params};
use crate::target::Classes;
use crate::{Device, Error, Result, ResultExt};

/// A learner with its parameters, device and model: empty after construction, ready after [`Handle::load`].
///
/// It has one stream; [`Handle::stream`] creates more.
pub struct Handle<L: Learner> {
    params: L::Params,
    device: Device,
    ready: Option<Ready<L>>,
}

struct Ready<L: Learner> {
    model: Model,
    stream: Stream<L>,
}

impl<L: Learner> Handle<L> {
    /// Creates an empty handle.
    ///
    /// # Errors
    /// Returns `InvalidParam` if a parameter is out of range or `OPENDR_DEVICE` names no device.
    pub fn new(params: L::Params, device: Device) -> Result<Self> {
        params.check()?;
        Ok(Self { params, device: device.or_environment()?, ready: None })
    }

    /// Loads a model container (a folder, its `model.json`, or a zip).
    ///
    /// Parameters of the container replace those that still have their default.
    ///
    /// # Errors
    /// Returns `NotFound`, `Format` or `Integrity` if the container is missing, damaged, or of another learner.
    pub fn load(&mut self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        self.load_model(Model::open(path).context(|| format!("loading {}", L::SPEC.name))?)
    }

    /// Loads an open container.
    ///
    /// # Errors
    /// As [`Handle::load`].
    pub fn load_model(&mut self, model: Model) -> Result<()> {
        let context = || format!("loading {} from {}", L::SPEC.name, model.path().display());
        model.check_learner(L::SPEC.name)?;
        let mut params = self.params.clone();
        for (index, field) in L::Params::FIELDS.iter().enumerate() {
            if let Some(stated) = field.value_in(model.params())
                && params.get_at(index) == field.default.value()
            {
                params.set(field.name, stated.clone()).context(context)?;
            }
        }
        let learner = L::load(&model, params, self.device.for_inference()).context(context)?;
        self.params = learner.params().clone();
        self.ready = Some(Ready { stream: Stream::new(Arc::new(RwLock::new(learner))), model });
        Ok(())
    }

    /// Writes the model with the current parameters as a container to the folder `path`.
    ///
    /// # Errors
    /// Returns `NotFound` if no model is loaded, `Io` if the folder cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let model = &self.ready()?.model;
        let manifest =
            Manifest { params: self.params.to_map(), files: Vec::new(), ..model.manifest().clone() };
        let mut writer = ModelWriter::new(path, manifest)?;
        for file in &model.manifest().files {
            writer.add(&file.name, &model.file(&file.name)?)?;
        }
        writer.finish()?;
        Ok(())
    }

    /// Returns whether a model is loaded.
    pub fn is_ready(&self) -> bool {
        self.ready.is_some()
    }

    /// Returns the prediction for `input`, on the handle's own stream.
    ///
    /// # Errors
    /// Returns `NotFound` if no model is loaded; otherwise as [`Learner::infer_into`].
    pub fn infer(&mut self, input: L::Input<'_>) -> Result<L::Target> {
        self.own_stream()?.infer(input)
    }

    /// Writes the prediction for `input` into `target`, on the handle's own stream; the memory of `target` is reused.
    ///
    /// # Errors
    /// As [`Handle::infer`].
    pub fn infer_into(&mut self, input: L::Input<'_>, target: &mut L::Target) -> Result<()> {
        self.own_stream()?.infer_into(input, target)
    }

    /// Returns the predictions for several inputs in order, on the handle's own stream.
    ///
    /// # Errors
    /// As [`Handle::infer`].
    pub fn infer_batch(&mut self, inputs: Vec<L::Input<'_>>) -> Result<Vec<L::Target>> {
        self.own_stream()?.infer_batch(inputs)
    }

    /// Creates another stream, for another camera, topic or thread.
    ///
    /// # Errors
    /// Returns `NotFound` if no model is loaded.
    pub fn stream(&self) -> Result<Stream<L>> {
        Ok(Stream::new(self.ready()?.stream.learner().clone()))
    }

    /// Resets the state of the handle's own stream.
    pub fn reset(&mut self) {
        if let Some(ready) = &mut self.ready {
            ready.stream.reset();
        }
    }

    /// Returns the parameters.
    pub fn params(&self) -> &L::Params {
        &self.params
    }

    /// Returns the default of a parameter: that of the loaded model, otherwise that of the learner.
    pub fn default_of(&self, name: &str) -> Option<ParamValue> {
        let field = L::Params::FIELDS.iter().find(|field| field.is_called(name))?;
        let stated = self.model().and_then(|model| field.value_in(model.params()));
        Some(stated.cloned().unwrap_or_else(|| field.default.value()))
    }

    /// Returns the requested device.
    pub fn device(&self) -> Device {
        self.device
    }

    /// Returns the loaded container.
    pub fn model(&self) -> Option<&Model> {
        self.ready.as_ref().map(|ready| &ready.model)
    }

    /// Returns the classes that the learner predicts; empty before `load`.
    pub fn classes(&self) -> Classes {
        match &self.ready {
            Some(ready) => ready.stream.learner().read().unwrap_or_else(PoisonError::into_inner).classes(),
            None => Classes::default(),
        }
    }

    /// As [`Learner::metric_params`]; none before `load`.
    pub fn metric_params(&self) -> ParamMap {
        let ready = self.ready.as_ref();
        let learner =
            ready.map(|ready| ready.stream.learner().read().unwrap_or_else(PoisonError::into_inner));
        learner.map(|learner| learner.metric_params()).unwrap_or_default()
    }

    /// Sets a parameter. While a model is loaded, only `live` parameters can be set; every stream uses the new value from
    /// its next call.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the parameter is unknown, of another type, out of range, or not live.
    pub fn set(&mut self, name: &str, value: ParamValue) -> Result<()> {
        let mut params = self.params.clone();
        params.set(name, value)?;
        if let Some(ready) = &self.ready {
            if L::Params::FIELDS.iter().any(|field| field.is_called(name) && !field.live) {
                return Err(Error::invalid_param(format!(
                    "{name} cannot change while a model is loaded; set it on a new {} and load again",
                    L::SPEC.class
                )));
            }
            let mut learner = ready.stream.learner().write().unwrap_or_else(PoisonError::into_inner);
            *learner.params_mut() = params.clone();
        }
        self.params = params;
        Ok(())
    }

    pub(crate) fn own_stream(&mut self) -> Result<&mut Stream<L>> {
        match &mut self.ready {
            Some(ready) => Ok(&mut ready.stream),
            None => Err(empty_learner(L::SPEC.class)),
        }
    }

    fn ready(&self) -> Result<&Ready<L>> {
        self.ready.as_ref().ok_or_else(|| empty_learner(L::SPEC.class))
    }
}

/// Returns the error of a handle without a model; its message names the three ways to get one.
#[cold]
pub fn empty_learner(class: &str) -> Error {
    Error::not_found(format!(
        "{class} has no model yet: call download() and load() for a pretrained one, load() for your own, or fit() to train one"
    ))
}
