//! What users hold: empty after construction, ready after `load`.

use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

use crate::learner::{Learner, Stream};
use crate::model::{Manifest, Model, ModelWriter};
use crate::params::{ParamValue, Params};
use crate::target::Classes;
use crate::{Device, Error, Result, ResultExt};

/// A learner through its life: empty after construction, ready after [`Handle::load`].
///
/// It has one stream of its own; [`Handle::stream`] gives more.
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
    /// An empty handle.
    ///
    /// # Errors
    /// `InvalidParam` when a parameter is out of range, or `OPENDR_DEVICE` names no device.
    pub fn new(params: L::Params, device: Device) -> Result<Self> {
        params.check()?;
        Ok(Self { params, device: device.or_environment()?, ready: None })
    }

    /// Loads a model container (a folder, its `model.json`, or a zip).
    ///
    /// Parameters that the container states replace those that still have their default.
    ///
    /// # Errors
    /// `NotFound`, `Format` or `Integrity` for a container that is missing, of another learner, or damaged.
    pub fn load(&mut self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        self.load_model(Model::open(path).context(|| format!("loading {}", L::SPEC.name))?)
    }

    /// Loads an opened container.
    ///
    /// # Errors
    /// As [`Handle::load`].
    pub fn load_model(&mut self, model: Model) -> Result<()> {
        let context = || format!("loading {} from {}", L::SPEC.name, model.path().display());
        model.check_learner(L::SPEC.name)?;
        let mut params = self.params.clone();
        for (index, field) in L::Params::FIELDS.iter().enumerate() {
            if let Some(stated) = model.params().get(field.name)
                && params.get_at(index) == field.default.value()
            {
                params.set(field.name, stated.clone()).context(context)?;
            }
        }
        let learner = L::load(&model, params, self.device).context(context)?;
        self.params = learner.params().clone();
        self.ready = Some(Ready { stream: Stream::new(Arc::new(RwLock::new(learner))), model });
        Ok(())
    }

    /// Writes the model with the parameters in force as a container to the folder `path`.
    ///
    /// # Errors
    /// `NotFound` when nothing is loaded; `Io` when the folder cannot be written.
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

    /// Whether a model is loaded.
    pub fn is_ready(&self) -> bool {
        self.ready.is_some()
    }

    /// Answers `input` on the handle's own stream.
    ///
    /// # Errors
    /// `NotFound` when nothing is loaded, else as [`Learner::infer_into`].
    pub fn infer(&mut self, input: L::Input<'_>) -> Result<L::Target> {
        self.own_stream()?.infer(input)
    }

    /// Answers `target` to `input` on the handle's own stream; memory of `target` is used again.
    ///
    /// # Errors
    /// As [`Handle::infer`].
    pub fn infer_into(&mut self, input: L::Input<'_>, target: &mut L::Target) -> Result<()> {
        self.own_stream()?.infer_into(input, target)
    }

    /// Answers several inputs in order on the handle's own stream.
    ///
    /// # Errors
    /// As [`Handle::infer`].
    pub fn infer_batch(&mut self, inputs: Vec<L::Input<'_>>) -> Result<Vec<L::Target>> {
        self.own_stream()?.infer_batch(inputs)
    }

    /// A stream of its own, for another camera, topic or thread.
    ///
    /// # Errors
    /// `NotFound` when nothing is loaded.
    pub fn stream(&self) -> Result<Stream<L>> {
        Ok(Stream::new(self.ready()?.stream.learner().clone()))
    }

    /// Forgets what the handle's own stream remembers.
    pub fn reset(&mut self) {
        if let Some(ready) = &mut self.ready {
            ready.stream.reset();
        }
    }

    /// The parameters.
    pub fn params(&self) -> &L::Params {
        &self.params
    }

    /// What a parameter is where nobody sets it: what the loaded model states, otherwise the learner's own default.
    pub fn default_of(&self, name: &str) -> Option<ParamValue> {
        let field = L::Params::FIELDS.iter().find(|field| field.name == name)?;
        let stated = self.model().and_then(|model| model.params().get(name));
        Some(stated.cloned().unwrap_or_else(|| field.default.value()))
    }

    /// The device asked for.
    pub fn device(&self) -> Device {
        self.device
    }

    /// The container that is loaded.
    pub fn model(&self) -> Option<&Model> {
        self.ready.as_ref().map(|ready| &ready.model)
    }

    /// What class numbers mean; empty before `load`.
    pub fn classes(&self) -> Classes {
        match &self.ready {
            Some(ready) => ready.stream.learner().read().unwrap_or_else(PoisonError::into_inner).classes(),
            None => Classes::default(),
        }
    }

    /// Sets a parameter; on a loaded learner only one that is `live`. Every stream sees it with its next call.
    ///
    /// # Errors
    /// `InvalidParam` when it is unknown, of another type, out of range, or not live.
    pub fn set(&mut self, name: &str, value: ParamValue) -> Result<()> {
        let mut params = self.params.clone();
        params.set(name, value)?;
        if let Some(ready) = &self.ready {
            if L::Params::FIELDS.iter().any(|field| field.name == name && !field.live) {
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

/// The error of a handle without a model: it names the three ways out.
#[cold]
pub fn empty_learner(class: &str) -> Error {
    Error::not_found(format!(
        "{class} has no model yet: call download() and load() for a pretrained one, load() for your own, or fit() to train one"
    ))
}
