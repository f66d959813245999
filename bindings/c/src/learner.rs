//! Learners.

use std::ffi::c_char;
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr::learner::{AnyLearner, Entry, Outputs, Ports};
use opendr::params::{ParamMap, ParamValue};
use opendr::{Device, Error, Result, Silent};

use crate::handle::{self, Held, Out};
use crate::pointer::{optional_text, path, place, slice, text};
use crate::status::{guard, guard_value, opendr_status};
use crate::string::{Text, opendr_string};
use crate::texts::Texts;
use crate::value::{AnyValue, opendr_value};

/// A learner with its model; calls from several threads are serialised.
pub struct opendr_learner(());

/// A named input.
#[repr(C)]
pub struct opendr_input {
    /// Name of the input, e.g. "image".
    pub name: *const c_char,
    /// A datum or target; NULL omits an optional input.
    pub value: *const opendr_value,
}

/// A named output.
#[repr(C)]
pub struct opendr_output {
    /// Name of the output, e.g. "boxes".
    pub name: *const c_char,
    /// The prediction, set by the call, which must be freed; NULL if the call failed.
    pub value: *mut opendr_value,
}

pub(crate) struct Loaded {
    pub(crate) entry: &'static Entry,
    learner: Mutex<Box<dyn AnyLearner>>,
    texts: Texts,
}

impl Held for Loaded {
    const NAME: &'static str = "opendr_learner";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRlearn");
}

impl Loaded {
    /// # Safety
    /// The same as for [`handle::held`].
    pub(crate) unsafe fn of<'a>(learner: *const opendr_learner) -> Result<&'a Self> {
        // SAFETY: the caller's promise.
        unsafe { handle::held(learner, "learner") }
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, Box<dyn AnyLearner>> {
        self.learner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Loads a learner, e.g. "nanodet" or "yunet/320".
///
/// path is a model container of your own; NULL loads the pretrained model, which is downloaded the first time. device is
/// "cpu", "cuda:0", ...; NULL selects the best available. params_json is an object of parameters; NULL uses the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_load(
    name: *const c_char,
    path: *const c_char,
    device: *const c_char,
    params_json: *const c_char,
    learner: *mut *mut opendr_learner,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { load(name, path, device, params_json, learner) })
}

/// # Safety
/// The same as for [`opendr_load`].
unsafe fn load(
    name: *const c_char,
    container: *const c_char,
    device: *const c_char,
    params_json: *const c_char,
    learner: *mut *mut opendr_learner,
) -> Result<()> {
    // SAFETY: the caller's promise.
    let (out, request) = unsafe { (Out::new(learner, "learner")?, Request::of(name, device, params_json)?) };
    let learner = if container.is_null() {
        opendr::learner_with(request.spec, &request.params, request.device, &Silent)?
    } else {
        let mut learner = request.make()?;
        // SAFETY: the caller's promise.
        learner.load(unsafe { path(container, "path") }?)?;
        learner
    };
    out.set(request.loaded(learner));
    Ok(())
}

/// The caller's arguments that determine a learner.
struct Request<'a> {
    spec: &'a str,
    entry: &'static Entry,
    device: Device,
    params: ParamMap,
}

impl<'a> Request<'a> {
    /// # Safety
    /// The same as for [`opendr_load`].
    unsafe fn of(name: *const c_char, device: *const c_char, params_json: *const c_char) -> Result<Self> {
        // SAFETY: the caller's promise.
        let (spec, device, params) = unsafe {
            (
                text(name, "name")?,
                optional_text(device, "device")?.unwrap_or("auto"),
                optional_text(params_json, "params_json")?.unwrap_or("{}"),
            )
        };
        let entry = opendr::registry().find(spec.split('/').next().unwrap_or(spec))?;
        let device = device.parse()?;
        let params = serde_json::from_str(params).map_err(|error| {
            Error::invalid_param("params_json is not a JSON object of parameters").with_source(error)
        })?;
        Ok(Self { spec, entry, device, params })
    }

    fn make(&self) -> Result<Box<dyn AnyLearner>> {
        self.entry.make(&self.params, self.device)
    }

    fn loaded(&self, learner: Box<dyn AnyLearner>) -> Loaded {
        Loaded { entry: self.entry, learner: Mutex::new(learner), texts: Texts::default() }
    }
}

/// Creates a learner without a model, e.g. "ssd", for training with opendr_fit. device and params_json are the same as for
/// opendr_load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_create(
    name: *const c_char,
    device: *const c_char,
    params_json: *const c_char,
    learner: *mut *mut opendr_learner,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, request) =
            unsafe { (Out::new(learner, "learner")?, Request::of(name, device, params_json)?) };
        out.set(request.loaded(request.make()?));
        Ok(())
    })
}

/// Predicts the outputs for named inputs on the learner's own stream. Each requested output receives a new handle, which must
/// be freed; not all outputs have to be requested. The caller keeps the inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_infer(
    learner: *const opendr_learner,
    inputs: *const opendr_input,
    input_count: usize,
    outputs: *mut opendr_output,
    output_count: usize,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { infer(learner, inputs, input_count, outputs, output_count) })
}

/// # Safety
/// The same as for [`opendr_infer`].
unsafe fn infer(
    learner: *const opendr_learner,
    inputs: *const opendr_input,
    input_count: usize,
    outputs: *mut opendr_output,
    output_count: usize,
) -> Result<()> {
    // SAFETY: the caller's promise.
    let requested = unsafe { RequestedOutputs::new(outputs, output_count) }?;
    // SAFETY: the caller's promise.
    let (loaded, inputs) = unsafe { (Loaded::of(learner)?, slice(inputs, input_count, "inputs")?) };
    requested.check(loaded.entry)?;
    let mut ports = Ports::default();
    for input in inputs.iter().filter(|input| !input.value.is_null()) {
        // SAFETY: the caller's promise.
        let (name, value) = unsafe {
            (text(input.name, "the name of an input")?, AnyValue::of(input.value, "the value of an input")?)
        };
        if ports.get(name).is_some() {
            return Err(Error::invalid_input(format!("input {name:?} is given twice; give it once")));
        }
        ports = ports.with(name, &value.value);
    }
    let predicted = loaded.lock().infer(&ports)?;
    requested.write(&predicted)
}

/// The outputs that the caller requested.
struct RequestedOutputs<'a> {
    names: Vec<&'a str>,
    outputs: *mut opendr_output,
}

impl RequestedOutputs<'_> {
    /// Sets every value to null.
    ///
    /// # Safety
    /// `outputs` points to `count` outputs whose names are texts; they may be written to until this is dropped.
    unsafe fn new(outputs: *mut opendr_output, count: usize) -> Result<Self> {
        // SAFETY: the caller's promise.
        unsafe { slice(outputs.cast::<std::mem::MaybeUninit<opendr_output>>(), count, "outputs") }?;
        let mut names = Vec::new();
        for index in 0..count {
            // SAFETY: within the outputs.
            let name = unsafe {
                let output = outputs.add(index);
                (&raw mut (*output).value).write(ptr::null_mut());
                (*output).name
            };
            names.push(name);
        }
        // SAFETY: the caller's promise.
        let names = names.into_iter().map(|name| unsafe { text(name, "the name of an output") });
        Ok(Self { names: names.collect::<Result<_>>()?, outputs })
    }

    fn check(&self, entry: &Entry) -> Result<()> {
        let known: Vec<_> = entry.outputs.iter().map(|output| output.name).collect();
        match self.names.iter().find(|name| !known.contains(name)) {
            Some(name) => Err(Error::invalid_input(format!(
                "unknown output {name:?}; the outputs are {}",
                known.join(", ")
            ))),
            None => Ok(()),
        }
    }

    fn write(self, predicted: &Outputs) -> Result<()> {
        let values = self.names.iter().map(|name| predicted.get(name).cloned());
        let values: Option<Vec<_>> = values.collect();
        let values =
            values.ok_or_else(|| Error::internal("the learner omitted an output; please report it"))?;
        for (index, value) in values.into_iter().enumerate() {
            // SAFETY: within the outputs, as `new` was promised.
            unsafe {
                (&raw mut (*self.outputs.add(index)).value).write(handle::handle(AnyValue::from(value)))
            };
        }
        Ok(())
    }
}

/// Returns the name of the learner's input index, or NULL after the last; valid as long as the learner.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_input_name(learner: *const opendr_learner, index: usize) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let loaded = unsafe { Loaded::of(learner) }?;
        Ok(loaded.texts.keep_optional(loaded.entry.ports.get(index).map(|port| port.name)))
    })
}

/// Returns the type of the learner's input index, e.g. "Image", or NULL after the last; valid as long as the learner.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_input_type(learner: *const opendr_learner, index: usize) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let loaded = unsafe { Loaded::of(learner) }?;
        Ok(loaded.texts.keep_optional(loaded.entry.ports.get(index).map(|port| port.value_type.name())))
    })
}

/// Returns the name of the learner's output index, or NULL after the last; valid as long as the learner.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_output_name(learner: *const opendr_learner, index: usize) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let loaded = unsafe { Loaded::of(learner) }?;
        Ok(loaded.texts.keep_optional(loaded.entry.outputs.get(index).map(|output| output.name)))
    })
}

/// Sets a live parameter; value_json is a number, text, boolean, list or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_set_param(
    learner: *const opendr_learner,
    name: *const c_char,
    value_json: *const c_char,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (loaded, name, json) =
            unsafe { (Loaded::of(learner)?, text(name, "name")?, text(value_json, "value_json")?) };
        let value: ParamValue = serde_json::from_str(json).map_err(|error| {
            Error::invalid_param(format!("{name} = {json} is not a JSON value; write texts as \"text\""))
                .with_source(error)
        })?;
        loaded.lock().set(name, value)
    })
}

/// Writes the current parameters as a JSON object, which must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_params(
    learner: *const opendr_learner,
    json: *mut *mut opendr_string,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (json, loaded) = unsafe { (Out::new(json, "json")?, Loaded::of(learner)?) };
        let params = loaded.lock().params();
        json.set(Text::of_json(&params)?);
        Ok(())
    })
}

/// Resets the state of the learner's own stream.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_reset(learner: *const opendr_learner) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        unsafe { Loaded::of(learner) }?.lock().reset();
        Ok(())
    })
}

/// Writes the names of the classes in order as a JSON list, which must be freed; empty when classes have no names.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_classes(
    learner: *const opendr_learner,
    json: *mut *mut opendr_string,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (json, loaded) = unsafe { (Out::new(json, "json")?, Loaded::of(learner)?) };
        let classes = loaded.lock().classes();
        json.set(Text::of_json(&classes)?);
        Ok(())
    })
}

/// Writes the number of classes with names into count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_class_count(
    learner: *const opendr_learner,
    count: *mut usize,
) -> opendr_status {
    guard(|| {
        let count = place(count, "count")?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { count.write(Loaded::of(learner)?.lock().classes().len()) };
        Ok(())
    })
}

/// Returns the name of a class, or NULL if it has none; valid as long as the learner.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_class_name(
    learner: *const opendr_learner,
    class_index: i64,
) -> *const c_char {
    guard_value(ptr::null(), || {
        // SAFETY: the rules at the top of opendr.h.
        let loaded = unsafe { Loaded::of(learner) }?;
        let classes = loaded.lock().classes();
        Ok(loaded.texts.keep_optional(classes.name(class_index).map(|name| &**name)))
    })
}

/// Writes the model with the current parameters as a container to the folder path.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_save(learner: *const opendr_learner, path: *const c_char) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (loaded, path) = unsafe { (Loaded::of(learner)?, crate::pointer::path(path, "path")?) };
        loaded.lock().save(path)
    })
}

/// Frees the learner and sets the variable to NULL; does nothing if it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_learner_free(learner: *mut *mut opendr_learner) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Loaded, _>(learner, "learner") })
}

/// Writes the names of all learners as a JSON list, which must be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_learners(json: *mut *mut opendr_string) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let json = unsafe { Out::new(json, "json") }?;
        let names: Vec<_> = opendr::registry().entries().iter().map(|entry| entry.spec.name).collect();
        json.set(Text::of_json(&names)?);
        Ok(())
    })
}
