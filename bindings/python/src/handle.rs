//! Learners and streams, which the classes of the Python package wrap.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr::active::{ActiveContainer, EnvironmentScene, compare};
use opendr::data::Pixels as Samples;
use opendr::environment::EnvironmentSource;
use opendr::evaluation::Teacher;
use opendr::learner::{AnyLearner, AnyStream, Entry, Outputs, Port, Ports, TrainingGroup};
use opendr::params::ParamMap;
use opendr::rl::EvaluationProtocol;
use opendr::{Device, Error, FitData, FitEnvironments, FitOptions, PolicyEpisodes, Pool, Value, ValueType};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::bar::PythonBar;
use crate::dataset::{GivenDataset, types_of_ports};
use crate::datum::value_from_python;
use crate::environment::GivenEnvironments;
use crate::error::ToPython;
use crate::evaluate::eval_options_from_json;
use crate::group::PythonGroup;
use crate::param::{params_from_python, python_from_params};
use crate::pixels::image_from_python;
use crate::report::json_of;
use crate::target::{Payload, payloads};
use crate::{plugin, zoo};

/// A learner of the registry. Calls from several threads are serialised; [`Handle::stream`] gives each thread its own state.
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

    /// Loads the pretrained model, or a variant of it, which is downloaded into the cache if needed. Returns its folder.
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

    /// Returns the outputs for inputs by port name; `overrides` are live parameters for this call only.
    #[pyo3(signature = (ports, overrides=None))]
    fn infer(
        &self,
        py: Python<'_>,
        ports: &Bound<'_, PyDict>,
        overrides: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Vec<Payload>> {
        let overrides = overrides.map(params_from_python).transpose()?.unwrap_or_default();
        self.inputs.infer(py, ports, |ports| {
            let mut learner = lock(&self.learner);
            let previous = replace(learner.as_mut(), &overrides)?;
            let outputs = learner.infer(ports);
            replace(learner.as_mut(), &previous)?;
            outputs
        })
    }

    /// Processes the next chunk, `None` at the end. Returns the outputs that are ready.
    #[pyo3(signature = (ports=None))]
    fn push(&self, py: Python<'_>, ports: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<Vec<Payload>>> {
        self.inputs.push(py, ports, |ports, emit| lock(&self.learner).push(ports, emit))
    }

    /// Returns a stream with its own state, for another camera or thread.
    fn stream(&self, py: Python<'_>) -> PyResult<Stream> {
        let stream = py.detach(|| lock(&self.learner).stream()).to_python(py)?;
        Ok(Stream { stream: Mutex::new(stream), inputs: Inputs::of(self.entry) })
    }

    /// Evaluates the learner on a data set. `options` are JSON. Returns the outcome as JSON and as text.
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

    /// Returns the plan of an evaluation in at most `count` parts from sample `first` on: the first line of the file of predictions,
    /// parameters that the learners of the parts need, and the parts. `options` are those of `eval`.
    fn eval_plan<'py>(
        &self,
        py: Python<'py>,
        dataset: &Bound<'py, PyAny>,
        options: &str,
        first: usize,
        count: usize,
    ) -> PyResult<(String, Bound<'py, PyDict>, Vec<[usize; 2]>)> {
        let mut options = eval_options_from_json(options).to_python(py)?;
        let dataset = GivenDataset::from_python(dataset, &types_of_ports(self.entry.ports))?;
        options.name = Some(dataset.name());
        let plan = PythonBar::new(true).run(py, |_| {
            let learner = lock(&self.learner);
            options.open(self.entry, dataset.as_ref())?.plan(learner.as_ref(), self.entry, first, count)
        })?;
        Ok((plan.heading, python_from_params(py, &plan.params)?, plan.parts))
    }

    /// Predicts the samples from `part[0]` to before `part[1]`. Returns the lines of the file of predictions.
    fn eval_part(
        &self,
        py: Python<'_>,
        dataset: &Bound<'_, PyAny>,
        options: &str,
        part: [usize; 2],
    ) -> PyResult<String> {
        let options = eval_options_from_json(options).to_python(py)?;
        let dataset = GivenDataset::from_python(dataset, &types_of_ports(self.entry.ports))?;
        PythonBar::new(true).run(py, |bar| {
            let learner = &mut *lock(&self.learner);
            let job = options.open(self.entry, dataset.as_ref())?;
            job.predict_part(std::slice::from_mut(learner), self.entry, part[0]..part[1], bar)
        })
    }

    /// Trains the learner. `options` are JSON; `teacher` is another handle, or the name and the object of a learner written in
    /// Python; `group` is that of [`PythonGroup`]. Returns the report as JSON and as text.
    #[pyo3(signature = (dataset, val_dataset, teacher, options, silent, group=None))]
    #[expect(clippy::too_many_arguments, reason = "arguments of a Python function")]
    fn fit(
        &self,
        py: Python<'_>,
        dataset: &Bound<'_, PyAny>,
        val_dataset: Option<&Bound<'_, PyAny>>,
        teacher: Option<&Bound<'_, PyAny>>,
        options: &str,
        silent: bool,
        group: Option<PythonGroup>,
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
                group: group.as_ref().map(|group| group as &dyn TrainingGroup),
            };
            let fitted = opendr::fit(lock(&self.learner).as_mut(), self.entry, data, &options, bar)?;
            Ok((json_of(&fitted)?, fitted.to_string()))
        })
    }

    /// Returns the default output folder of a training: a new one, or that of the last training to resume.
    fn run_folder(&self, py: Python<'_>, resume: bool) -> PyResult<PathBuf> {
        FitOptions { resume, ..FitOptions::default() }.output_folder(self.entry.spec.name).to_python(py)
    }

    /// Trains the policy in an environment. `options` are JSON. Returns the report as JSON and as text.
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
                opendr::fit_policy(lock(&self.learner).as_mut(), self.entry, environments, &options, bar)?;
            Ok((json_of(&fitted)?, fitted.to_string()))
        })
    }

    /// Evaluates the policy on `episodes` episodes with consecutive seeds. Returns the report as JSON.
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
            let mut environment = env.make()?;
            let protocol = EvaluationProtocol { episodes, first_seed, ..EvaluationProtocol::default() };
            let learner = lock(&self.learner);
            let report =
                opendr::evaluate_learner(learner.as_ref(), self.entry, environment.as_mut(), &protocol, bar)?;
            json_of(&report)
        })
    }

    /// Runs the policy on a part of the episodes of an evaluation. Returns them as JSON for [`Self::eval_joined`].
    fn eval_in_part(
        &self,
        py: Python<'_>,
        env: &Bound<'_, PyAny>,
        episodes: u64,
        first_seed: u64,
    ) -> PyResult<String> {
        let env = GivenEnvironments::from_python(env)?;
        PythonBar::new(true).run(py, |bar| {
            let mut environment = env.make()?;
            let protocol = EvaluationProtocol { episodes, first_seed, ..EvaluationProtocol::default() };
            let learner = lock(&self.learner);
            let part = opendr::evaluate_episodes(
                learner.as_ref(),
                self.entry,
                environment.as_mut(),
                &protocol,
                bar,
            )?;
            json_of(&part)
        })
    }

    /// Joins the parts of an evaluation in their order. Returns the report as JSON and as text.
    #[staticmethod]
    fn eval_joined(py: Python<'_>, parts: Vec<String>, seconds: f64) -> PyResult<(String, String)> {
        let read = |part: &String| {
            serde_json::from_str::<PolicyEpisodes>(part)
                .map_err(|error| Error::format("episodes of an evaluation").with_source(error))
        };
        let joined = parts.iter().map(read).collect::<opendr::Result<_>>();
        let joined = joined.and_then(|parts| opendr::join_episodes(parts, seconds));
        joined.and_then(|report| Ok((json_of(&report)?, report.to_string()))).to_python(py)
    }

    /// Evaluates the camera policy and the baselines on `episodes` episodes with consecutive seeds. Returns the rows as JSON.
    fn eval_active(
        &self,
        py: Python<'_>,
        env: &Bound<'_, PyAny>,
        episodes: u64,
        first_seed: u64,
        verbose: bool,
    ) -> PyResult<String> {
        let env = GivenEnvironments::from_python(env)?;
        PythonBar::new(!verbose).run(py, |bar| {
            let container = ActiveContainer::of(lock(&self.learner).as_ref())?;
            let scene = EnvironmentScene::new(&env, container.recogniser)?;
            json_of(&compare(scene, &container.model, first_seed, episodes, bar)?)
        })
    }

    /// Id of the environment that the loaded policy was trained in.
    #[getter]
    fn trained_in(&self, py: Python<'_>) -> Option<String> {
        py.detach(|| opendr::training_environment(lock(&self.learner).as_ref()).map(str::to_owned))
    }

    /// Writes the optimised model to `output` and loads it. Returns the report as JSON and as text.
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
            let json = json.map_err(|error| {
                Error::internal("the report cannot be written as JSON").with_source(error)
            })?;
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

impl Handle {
    /// Calls `work` with the learner. Callers have released the GIL.
    pub fn with_learner<R>(&self, work: impl FnOnce(&dyn AnyLearner) -> R) -> R {
        work(lock(&self.learner).as_ref())
    }

    /// Calls `work` with the learner, which it may change. Callers have released the GIL.
    pub fn with_learner_mut<R>(&self, work: impl FnOnce(&mut dyn AnyLearner) -> R) -> R {
        work(lock(&self.learner).as_mut())
    }

    /// Returns the entry of the registry.
    pub fn entry(&self) -> &'static Entry {
        self.entry
    }
}

#[pymethods]
impl Stream {
    /// Returns the outputs for inputs by port name.
    fn infer(&self, py: Python<'_>, ports: &Bound<'_, PyDict>) -> PyResult<Vec<Payload>> {
        self.inputs.infer(py, ports, |ports| lock(&self.stream).infer(ports))
    }

    /// Processes the next chunk, `None` at the end. Returns the outputs that are ready.
    #[pyo3(signature = (ports=None))]
    fn push(&self, py: Python<'_>, ports: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<Vec<Payload>>> {
        self.inputs.push(py, ports, |ports, emit| lock(&self.stream).push(ports, emit))
    }

    fn reset(&self, py: Python<'_>) {
        py.detach(|| lock(&self.stream).reset());
    }
}

/// Reads the options of a training.
pub fn options_from_json(json: &str) -> opendr::Result<FitOptions> {
    serde_json::from_str(json)
        .map_err(|error| Error::invalid_param("invalid options of fit").with_source(error))
}

/// Converts the argument `teacher` of `fit`.
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

/// Locks a mutex. Callers have released the GIL, so that a learner written in Python can run meanwhile.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets parameters and returns their previous values.
fn replace(learner: &mut dyn AnyLearner, params: &ParamMap) -> opendr::Result<ParamMap> {
    let mut previous = learner.params();
    previous.retain(|name, _| params.contains_key(name));
    for (name, value) in params {
        if let Err(error) = learner.set(name, value.clone()) {
            previous.into_iter().try_for_each(|(name, value)| learner.set(&name, value))?;
            return Err(error);
        }
    }
    Ok(previous)
}

/// Conversion of a learner's inputs from Python.
struct Inputs {
    ports: &'static [Port],
    /// Memory of images, reused from call to call.
    spare: Pool<Vec<u8>>,
}

impl Inputs {
    fn of(entry: &Entry) -> Self {
        Self { ports: entry.ports, spare: Pool::default() }
    }

    /// Converts the inputs, calls `infer` with the GIL released, and returns the outputs.
    fn infer(
        &self,
        py: Python<'_>,
        ports: &Bound<'_, PyDict>,
        infer: impl FnOnce(&Ports<'_>) -> opendr::Result<Outputs> + Send,
    ) -> PyResult<Vec<Payload>> {
        let values = self.read(ports)?;
        let payloads = py.detach(|| {
            let outputs = infer(&named(&values));
            self.reclaim(values);
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
        let emitted: opendr::Result<_> = py.detach(|| {
            let mut emitted = Vec::new();
            push(values.as_deref().map(named).as_ref(), &mut |outputs| emitted.push(outputs))?;
            emitted.iter().map(payloads).collect()
        });
        emitted.to_python(py)
    }

    fn read(&self, ports: &Bound<'_, PyDict>) -> PyResult<Vec<(&'static str, Value)>> {
        let mut values = Vec::with_capacity(ports.len());
        for (name, object) in ports.iter() {
            let name: String = name.extract()?;
            let port = self.ports.iter().find(|port| port.name == name).ok_or_else(|| {
                let names: Vec<_> = self.ports.iter().map(|port| port.name).collect();
                PyTypeError::new_err(format!("unknown input {name:?}; the inputs are {}", names.join(", ")))
            })?;
            let value = match port.value_type {
                ValueType::Image => {
                    let spare = std::mem::take(&mut *self.spare.take());
                    Value::Image(image_from_python(&object, spare)?)
                }
                value_type => value_from_python(&object, value_type)?,
            };
            values.push((port.name, value));
        }
        Ok(values)
    }

    /// Keeps the memory of images that are not referenced elsewhere, for reuse.
    fn reclaim(&self, values: Vec<(&'static str, Value)>) {
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
