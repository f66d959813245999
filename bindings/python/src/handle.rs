//! A learner for Python: what the classes of the package hold.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr::data::Pixels as Samples;
use opendr::environment::EnvironmentSource;
use opendr::evaluation::Teacher;
use opendr::learner::{AnyLearner, AnyStream, Entry, Outputs, Port, Ports};
use opendr::params::ParamMap;
use opendr::rl::EvaluationProtocol;
use opendr::{
    ActingStream, Device, Error, FitData, FitEnvironments, FitOptions, Pool, Statistics, Value, ValueType,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::bar::PythonBar;
use crate::dataset::{GivenDataset, types_of_ports};
use crate::datum::value_from_python;
use crate::environment::GivenEnvironments;
use crate::error::ToPython;
use crate::evaluate::eval_options_from_json;
use crate::param::{params_from_python, python_from_params};
use crate::pixels::image_from_python;
use crate::target::{Payload, payloads};
use crate::{plugin, zoo};

/// A learner of the registry. Calls from several threads wait for each other; [`Handle::stream`] gives each its own.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Handle {
    entry: &'static Entry,
    learner: Mutex<Box<dyn AnyLearner>>,
    inputs: Inputs,
}

/// A stream of a loaded learner.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Stream {
    stream: Mutex<Box<dyn AnyStream>>,
    inputs: Inputs,
}

#[pymethods]
impl Handle {
    #[new]
    fn new(py: Python<'_>, name: &str, params: &Bound<'_, PyDict>, device: &str) -> PyResult<Self> {
        let entry = opendr::registry().find(name).to_python(py)?;
        let params = params_from_python(params)?;
        let learner =
            device.parse::<Device>().and_then(|device| entry.make(&params, device)).to_python(py)?;
        Ok(Self { entry, learner: Mutex::new(learner), inputs: Inputs::of(entry) })
    }

    /// Loads a container.
    fn load(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| lock(&self.learner).load(&path)).to_python(py)
    }

    /// Loads the pretrained model, or a variant of it, got into the cache where it is not there; its folder.
    #[pyo3(signature = (variant=None, verbose=true))]
    fn load_pretrained(&self, py: Python<'_>, variant: Option<String>, verbose: bool) -> PyResult<PathBuf> {
        let spec = zoo::spec(self.entry.spec.name, variant.as_deref());
        PythonBar::new(!verbose).run(py, |bar| {
            let path = zoo::open()?.get(&spec, bar)?;
            lock(&self.learner).load(&path)?;
            Ok(path)
        })
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| lock(&self.learner).save(&path)).to_python(py)
    }

    #[getter]
    fn is_ready(&self, py: Python<'_>) -> bool {
        py.detach(|| lock(&self.learner).is_ready())
    }

    /// Answers named ports; `overrides` are live parameters for this call only.
    #[pyo3(signature = (ports, overrides=None))]
    fn infer(
        &self,
        py: Python<'_>,
        ports: &Bound<'_, PyDict>,
        overrides: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Vec<Payload>> {
        let overrides = overrides.map(params_from_python).transpose()?.unwrap_or_default();
        self.inputs.answer(py, ports, |ports| {
            let mut learner = lock(&self.learner);
            let kept = replace(learner.as_mut(), &overrides)?;
            let outputs = learner.infer(ports);
            replace(learner.as_mut(), &kept)?;
            outputs
        })
    }

    /// Takes the next piece, `None` at the end; what it found.
    #[pyo3(signature = (ports=None))]
    fn push(&self, py: Python<'_>, ports: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<Vec<Payload>>> {
        self.inputs.push(py, ports, |ports, emit| lock(&self.learner).push(ports, emit))
    }

    /// A stream of its own for another camera or thread.
    fn stream(&self, py: Python<'_>) -> PyResult<Stream> {
        let stream = py.detach(|| lock(&self.learner).stream()).to_python(py)?;
        Ok(Stream { stream: Mutex::new(stream), inputs: Inputs::of(self.entry) })
    }

    /// Measures the learner on a data set; the outcome as JSON and as text. `options` are JSON.
    fn eval(
        &self,
        py: Python<'_>,
        dataset: &Bound<'_, PyAny>,
        options: &str,
        verbose: bool,
    ) -> PyResult<(String, String)> {
        let mut options = eval_options_from_json(options).to_python(py)?;
        let dataset = GivenDataset::from_python(dataset, &types_of_ports(self.entry.ports))?;
        options.name = Some(dataset.name());
        PythonBar::new(!verbose).run(py, |bar| {
            let outcome = options.run(&mut lock(&self.learner), self.entry, dataset.as_ref(), bar)?;
            Ok((json_of(&outcome)?, outcome.to_string()))
        })
    }

    /// Trains the learner; the report as JSON and as text. `options` are JSON; a `teacher` is another handle, or the name and
    /// the object of a learner written in Python.
    fn fit(
        &self,
        py: Python<'_>,
        dataset: &Bound<'_, PyAny>,
        val_dataset: Option<&Bound<'_, PyAny>>,
        teacher: Option<&Bound<'_, PyAny>>,
        options: &str,
        silent: bool,
    ) -> PyResult<(String, String)> {
        let mut options = options_from_json(options).to_python(py)?;
        opendr::check_fit(self.entry, &options.params).to_python(py)?;
        let given = |object| GivenDataset::from_python(object, &types_of_ports(self.entry.ports));
        let (dataset, val_dataset) = (given(dataset)?, val_dataset.map(given).transpose()?);
        let teacher = teacher.map(teacher_from_python).transpose()?;
        options.name = Some(dataset.name());
        PythonBar::new(silent).run(py, |bar| {
            let data = FitData {
                dataset: dataset.as_ref(),
                val_dataset: val_dataset.as_ref().map(GivenDataset::as_ref),
                teacher,
            };
            let fitted = opendr::fit(lock(&self.learner).as_mut(), self.entry, data, &options, bar)?;
            Ok((json_of(&fitted)?, fitted.to_string()))
        })
    }

    /// Makes the model smaller and loads the result; the report as JSON and as text.
    #[pyo3(signature = (env, val_env, options, silent))]
    fn fit_in(
        &self,
        py: Python<'_>,
        env: &Bound<'_, PyAny>,
        val_env: Option<&Bound<'_, PyAny>>,
        options: &str,
        silent: bool,
    ) -> PyResult<(String, String)> {
        let options = options_from_json(options).to_python(py)?;
        opendr::check_fit(self.entry, &options.params).to_python(py)?;
        let env = GivenEnvironments::from_python(env)?;
        let val_env = val_env.map(GivenEnvironments::from_python).transpose()?;
        PythonBar::new(silent).run(py, |bar| {
            let val_env = val_env.as_ref().map(|val_env| val_env as &dyn EnvironmentSource);
            let environments = FitEnvironments { env: &env, val_env };
            let fitted =
                opendr::fit_in(lock(&self.learner).as_mut(), self.entry, environments, &options, bar)?;
            Ok((json_of(&fitted)?, fitted.to_string()))
        })
    }

    /// Measures the policy on fixed episodes; the numbers as JSON.
    fn eval_in(
        &self,
        py: Python<'_>,
        env: &Bound<'_, PyAny>,
        episodes: u64,
        first_seed: u64,
        verbose: bool,
    ) -> PyResult<String> {
        let env = GivenEnvironments::from_python(env)?;
        PythonBar::new(!verbose).run(py, |bar| {
            let stream = lock(&self.learner).stream()?;
            let mut environment = env.make()?;
            let mut acting = ActingStream::new(stream, self.entry, environment.spec())?;
            let protocol = EvaluationProtocol { episodes, first_seed, ..EvaluationProtocol::default() };
            let report = opendr::eval_in(&mut acting, environment.as_mut(), &protocol, bar)?;
            json_of(&Statistics::from(&report).scalars)
        })
    }

    /// The environment that the loaded policy was trained in.
    #[getter]
    fn trained_in(&self, py: Python<'_>) -> Option<String> {
        py.detach(|| opendr::trained_in(lock(&self.learner).as_ref()).map(str::to_owned))
    }

    fn optimize(
        &self,
        py: Python<'_>,
        output: PathBuf,
        options: &Bound<'_, PyDict>,
        calibration: Option<&Bound<'_, PyAny>>,
        validation: Option<&Bound<'_, PyAny>>,
        verbose: bool,
    ) -> PyResult<(String, String)> {
        let given = |object| GivenDataset::from_python(object, &types_of_ports(self.entry.ports));
        let (calibration, validation) =
            (calibration.map(given).transpose()?, validation.map(given).transpose()?);
        let options = params_from_python(options)?;
        PythonBar::new(!verbose).run(py, |bar| {
            let data = [&calibration, &validation].map(|data| data.as_ref().map(GivenDataset::as_ref));
            let mut learner = lock(&self.learner);
            let report = opendr::optimize_loaded(learner.as_mut(), self.entry, data, &options, &output, bar)?;
            let json = serde_json::to_string(&report);
            let json = json.map_err(|error| Error::internal("no JSON form").with_source(error))?;
            Ok((json, report.to_string()))
        })
    }

    fn reset(&self, py: Python<'_>) {
        py.detach(|| lock(&self.learner).reset());
    }

    fn params<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let params = py.detach(|| lock(&self.learner).params());
        python_from_params(py, &params)
    }

    fn set(&self, py: Python<'_>, params: &Bound<'_, PyDict>) -> PyResult<()> {
        let params = params_from_python(params)?;
        py.detach(|| replace(lock(&self.learner).as_mut(), &params)).map(drop).to_python(py)
    }

    #[getter]
    fn classes(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| lock(&self.learner).classes().iter().map(str::to_owned).collect())
    }

    #[getter]
    fn device(&self, py: Python<'_>) -> String {
        py.detach(|| lock(&self.learner).device().to_string())
    }
}

#[pymethods]
impl Stream {
    /// As [`Handle::infer`].
    fn infer(&self, py: Python<'_>, ports: &Bound<'_, PyDict>) -> PyResult<Vec<Payload>> {
        self.inputs.answer(py, ports, |ports| lock(&self.stream).infer(ports))
    }

    /// As [`Handle::push`].
    #[pyo3(signature = (ports=None))]
    fn push(&self, py: Python<'_>, ports: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<Vec<Payload>>> {
        self.inputs.push(py, ports, |ports, emit| lock(&self.stream).push(ports, emit))
    }

    fn reset(&self, py: Python<'_>) {
        py.detach(|| lock(&self.stream).reset());
    }
}

fn options_from_json(json: &str) -> opendr::Result<FitOptions> {
    serde_json::from_str(json).map_err(|error| Error::invalid_param("no options of fit").with_source(error))
}

pub fn json_of(report: &impl serde::Serialize) -> opendr::Result<String> {
    serde_json::to_string(report).map_err(|error| Error::internal("no JSON form").with_source(error))
}

/// The teacher that `fit` is given.
fn teacher_from_python(teacher: &Bound<'_, PyAny>) -> PyResult<Teacher> {
    let py = teacher.py();
    let Ok(handle) = teacher.cast::<Handle>() else {
        let (name, object): (String, Bound<'_, PyAny>) = teacher.extract()?;
        return plugin::teacher(&name, &object);
    };
    let handle = handle.get();
    let make = || opendr::teacher(handle.entry.spec.name, lock(&handle.learner).as_ref(), handle.entry);
    py.detach(make).to_python(py)
}

/// Whoever waits here has released the interpreter, so that a learner written in Python can run meanwhile.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets parameters; what they were.
fn replace(learner: &mut dyn AnyLearner, params: &ParamMap) -> opendr::Result<ParamMap> {
    let mut kept = learner.params();
    kept.retain(|name, _| params.contains_key(name));
    for (name, value) in params {
        if let Err(error) = learner.set(name, value.clone()) {
            kept.into_iter().try_for_each(|(name, value)| learner.set(&name, value))?;
            return Err(error);
        }
    }
    Ok(kept)
}

/// How a learner's inputs come from Python.
struct Inputs {
    ports: &'static [Port],
    /// Memory of pictures, used again from call to call.
    spare: Pool<Vec<u8>>,
}

impl Inputs {
    fn of(entry: &Entry) -> Self {
        Self { ports: entry.ports, spare: Pool::default() }
    }

    fn answer(
        &self,
        py: Python<'_>,
        ports: &Bound<'_, PyDict>,
        infer: impl FnOnce(&Ports<'_>) -> opendr::Result<Outputs> + Send,
    ) -> PyResult<Vec<Payload>> {
        let values = self.read(ports)?;
        let payloads = py.detach(|| {
            let outputs = infer(&named(&values));
            self.keep(values);
            payloads(&outputs?)
        });
        payloads.to_python(py)
    }

    fn push(
        &self,
        py: Python<'_>,
        ports: Option<&Bound<'_, PyDict>>,
        push: impl FnOnce(Option<&Ports<'_>>, &mut dyn FnMut(Outputs)) -> opendr::Result<()> + Send,
    ) -> PyResult<Vec<Vec<Payload>>> {
        let values = ports.map(|ports| self.read(ports)).transpose()?;
        let found: opendr::Result<_> = py.detach(|| {
            let mut found = Vec::new();
            push(values.as_deref().map(named).as_ref(), &mut |outputs| found.push(outputs))?;
            found.iter().map(payloads).collect()
        });
        found.to_python(py)
    }

    fn read(&self, ports: &Bound<'_, PyDict>) -> PyResult<Vec<(&'static str, Value)>> {
        let mut values = Vec::with_capacity(ports.len());
        for (name, object) in ports.iter() {
            let name: String = name.extract()?;
            let port = self.ports.iter().find(|port| port.name == name).ok_or_else(|| {
                let names: Vec<_> = self.ports.iter().map(|port| port.name).collect();
                PyTypeError::new_err(format!("no input {name:?}; there are {}", names.join(", ")))
            })?;
            let value = match port.value_type {
                ValueType::Image => {
                    let spare = std::mem::take(&mut *self.spare.take());
                    Value::Image(image_from_python(&object, spare)?)
                }
                wanted => value_from_python(&object, wanted)?,
            };
            values.push((port.name, value));
        }
        Ok(values)
    }

    /// Keeps the memory of pictures that nobody else holds.
    fn keep(&self, values: Vec<(&'static str, Value)>) {
        for (_, value) in values {
            if let Value::Image(image) = value
                && let Samples::U8(samples) = image.into_pixels()
                && let Some(samples) = std::sync::Arc::into_inner(samples)
            {
                *self.spare.take() = samples;
            }
        }
    }
}

fn named<'a>(values: &'a [(&'static str, Value)]) -> Ports<'a> {
    values.iter().fold(Ports::default(), |ports, (name, value)| ports.with(name, value.as_value_ref()))
}
