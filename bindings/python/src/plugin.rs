//! Learners written in Python, in the same registry as the native ones.

use std::path::{Path, PathBuf};

use opendr::dataset::DatasetRef;
use opendr::evaluation::{Subject, Teacher};
use opendr::learner::{
    AnyLearner, AnyStream, Capabilities, CheckOptions, Entry, FitJob, Output, Outputs, Port, Ports, Spec,
    empty_learner,
};
use opendr::params::{Field, FieldDefault, ParamKind, ParamMap, ParamRange, ParamValue};
use opendr::target::Classes;
use opendr::{Device, Error, Header, Result, Statistics, Task, Value, ValueType};
use pyo3::exceptions::{PyLookupError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::datum::{python_from_value, value_from_python};
use crate::error::{ToPython, error_from_exception};
use crate::param::{param_from_python, python_from_param, python_from_params};

/// Adds a Python class to the registry; `tables` are its parameters, ports and outputs in the form of `entries()`.
#[pyfunction]
pub fn register(py: Python<'_>, class: Py<PyAny>, tables: &Bound<'_, PyDict>) -> PyResult<()> {
    let tables = Tables(tables);
    let text = |name: &str| tables.text(name);
    let task: Task = text("task")?.parse::<Task>().to_python(py)?;
    let spec = Spec::new(text("name")?, task).class(text("class_name")?).about(text("about")?);
    let params: &'static [Field] = leak(tables.rows("params", field)?);
    let ports: &'static [Port] = leak(tables.rows("ports", port)?);
    let outputs: &'static [Output] = leak(tables.rows("outputs", output)?);
    let make = move |given: &ParamMap, device: Device| {
        if let Some(name) = given.keys().find(|name| params.iter().all(|field| field.name != name.as_str())) {
            return Err(Error::invalid_param(format!("{} has no parameter {name:?}", spec.class)));
        }
        let mut values = ParamMap::new();
        for field in params {
            let value = given.get(field.name).cloned().unwrap_or_else(|| field.default.value());
            field.check(&value)?;
            values.insert(field.name.to_owned(), value);
        }
        let object = attach(|py| {
            let keywords = python_from_params(py, &values)?;
            keywords.set_item("device", device.to_string())?;
            class.call(py, (), Some(&keywords))
        })?;
        let learner = PythonLearner { spec, params, ports, outputs, object, values, device, loaded: false };
        Ok(Box::new(learner) as Box<dyn AnyLearner>)
    };
    opendr::registry().add(Entry::dynamic(spec, params, ports, outputs, make)).to_python(py)
}

/// Runs the test that every learner passes. `calls` are the inputs of one stream by port: at least two, which differ.
#[pyfunction]
pub fn check_learner(
    py: Python<'_>,
    name: &str,
    model: PathBuf,
    scratch: PathBuf,
    calls: Vec<Bound<'_, PyDict>>,
) -> PyResult<()> {
    let entry = opendr::registry().find(name).to_python(py)?;
    let mut read = Vec::with_capacity(calls.len());
    for call in &calls {
        let mut values = Vec::new();
        for port in entry.ports {
            if let Some(object) = call.get_item(port.name)? {
                values.push((port.name, value_from_python(&object, port.value_type)?));
            }
        }
        read.push(values);
    }
    let options = CheckOptions { model: &model, scratch: &scratch, calls: &read };
    py.detach(|| opendr::learner::check_learner(entry, &options)).to_python(py)
}

/// The tables of a Python learner.
struct Tables<'a, 'py>(&'a Bound<'py, PyDict>);

impl<'py> Tables<'_, 'py> {
    fn get(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.0.get_item(name)?.ok_or_else(|| PyLookupError::new_err(format!("{name:?} is missing")))
    }

    fn text(&self, name: &str) -> PyResult<&'static str> {
        Ok(leak_text(self.get(name)?.extract()?))
    }

    fn rows<T>(&self, name: &str, row: fn(&Tables<'_, 'py>) -> PyResult<T>) -> PyResult<Vec<T>> {
        let rows: Vec<Bound<'py, PyDict>> = self.get(name)?.extract()?;
        rows.iter().map(|dict| row(&Tables(dict))).collect()
    }

    fn value_type(&self) -> PyResult<ValueType> {
        let parsed = self.text("type")?.parse();
        parsed.map_err(|error: Error| PyValueError::new_err(error.to_string()))
    }
}

/// Leaks a table: a registered learner lives as long as the process.
fn leak<T>(rows: Vec<T>) -> &'static [T] {
    Vec::leak(rows)
}

fn leak_text(text: String) -> &'static str {
    String::leak(text)
}

fn field(row: &Tables<'_, '_>) -> PyResult<Field> {
    let kind = match row.text("kind")? {
        "float" => ParamKind::Float,
        "int" => ParamKind::Int,
        "bool" => ParamKind::Bool,
        "text" => ParamKind::Text,
        "list" => ParamKind::List,
        other => return Err(PyValueError::new_err(format!("unknown parameter kind {other:?}"))),
    };
    let choices: Vec<String> = row.get("choices")?.extract()?;
    let range: Option<(f64, f64)> = row.get("range")?.extract()?;
    Ok(Field {
        name: row.text("name")?,
        doc: row.text("doc")?,
        kind,
        optional: row.get("optional")?.extract()?,
        choices: leak(choices.into_iter().map(leak_text).collect()),
        range: range.map(|(low, high)| ParamRange { low, high }),
        unit: row.text("unit")?,
        log_scale: false,
        live: row.get("live")?.extract()?,
        aliases: &[],
        former: &[],
        default: FieldDefault::Value(Box::leak(Box::new(param_from_python(&row.get("default")?)?))),
    })
}

fn port(row: &Tables<'_, '_>) -> PyResult<Port> {
    Ok(Port {
        name: row.text("name")?,
        doc: "",
        value_type: row.value_type()?,
        optional: row.get("optional")?.extract()?,
        init: row.get("init")?.extract()?,
    })
}

fn output(row: &Tables<'_, '_>) -> PyResult<Output> {
    let value_type = row.value_type()?;
    let name: Option<String> = row.get("name")?.extract()?;
    Ok(Output { name: name.map_or(value_type.port(), leak_text), doc: "", value_type })
}

/// Returns an instance of a registered class as a teacher.
pub fn teacher(name: &str, object: &Bound<'_, PyAny>) -> PyResult<Teacher> {
    let entry = opendr::registry().find(name).to_python(object.py())?;
    let classes = object.getattr("classes").and_then(|classes| classes.extract::<Vec<String>>());
    let object = object.call_method0("stream")?.unbind();
    let stream = PythonStream { ports: entry.ports, outputs: entry.outputs, object };
    Ok(Teacher {
        subject: Subject { learner: name.to_owned(), ..Subject::default() },
        entry,
        classes: classes.unwrap_or_default().into_iter().collect(),
        streams: vec![Box::new(stream)],
    })
}

/// Calls Python; an exception becomes the source of the error.
fn attach<T>(call: impl FnOnce(Python<'_>) -> PyResult<T>) -> Result<T> {
    Python::attach(|py| call(py).map_err(|raised| error_from_exception(py, raised)))
}

/// A learner that calls an instance of a registered class.
struct PythonLearner {
    spec: Spec,
    params: &'static [Field],
    ports: &'static [Port],
    outputs: &'static [Output],
    object: Py<PyAny>,
    values: ParamMap,
    device: Device,
    loaded: bool,
}

/// A stream that calls the object returned by `stream()` of the instance.
struct PythonStream {
    ports: &'static [Port],
    outputs: &'static [Output],
    object: Py<PyAny>,
}

impl PythonLearner {
    fn check_loaded(&self) -> Result<()> {
        match self.loaded {
            true => Ok(()),
            false => Err(empty_learner(self.spec.class)),
        }
    }

    fn cannot(&self, what: &str) -> Error {
        Error::unsupported(format!("{} cannot {what}", self.spec.class))
    }
}

impl AnyLearner for PythonLearner {
    fn load(&mut self, path: &Path) -> Result<()> {
        if !path.exists() {
            return Err(Error::not_found(format!(
                "loading {}: {} does not exist",
                self.spec.name,
                path.display()
            )));
        }
        attach(|py| self.object.call_method1(py, "load", (path,)))?;
        self.loaded = true;
        Ok(())
    }

    fn save(&self, path: &Path) -> Result<()> {
        self.check_loaded()?;
        attach(|py| self.object.call_method1(py, "save", (path,))).map(drop)
    }

    fn is_ready(&self) -> bool {
        self.loaded
    }

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        self.check_loaded()?;
        call_infer(&self.object, ports, self.ports, self.outputs)
    }

    fn push(&mut self, _: Option<&Ports<'_>>, _: &mut dyn FnMut(Outputs)) -> Result<()> {
        Err(self.cannot("process its input in chunks"))
    }

    fn fit(
        &mut self,
        _: &ParamMap,
        _: DatasetRef<'_>,
        _: Option<DatasetRef<'_>>,
        _: &FitJob<'_>,
    ) -> Result<Statistics> {
        Err(self.cannot("be trained outside Python; call its fit() in Python"))
    }

    fn reset(&mut self) {
        reset(&self.object);
    }

    fn stream(&self) -> Result<Box<dyn AnyStream>> {
        self.check_loaded()?;
        let object = attach(|py| self.object.call_method0(py, "stream"))?;
        Ok(Box::new(PythonStream { ports: self.ports, outputs: self.outputs, object }))
    }

    fn params(&self) -> ParamMap {
        self.values.clone()
    }

    fn default_of(&self, name: &str) -> Option<ParamValue> {
        self.params.iter().find(|field| field.is_called(name)).map(|field| field.default.value())
    }

    fn set(&mut self, name: &str, value: ParamValue) -> Result<()> {
        let field = self.params.iter().find(|field| field.is_called(name));
        let field = field
            .ok_or_else(|| Error::invalid_param(format!("{} has no parameter {name:?}", self.spec.class)))?;
        field.check(&value)?;
        if self.loaded && !field.live {
            return Err(Error::invalid_param(format!("{name} cannot change while a model is loaded")));
        }
        attach(|py| self.object.setattr(py, name, python_from_param(py, &value)?))?;
        self.values.insert(name.to_owned(), value);
        Ok(())
    }

    fn classes(&self) -> Classes {
        let names: Vec<String> =
            attach(|py| self.object.getattr(py, "classes")?.extract(py)).unwrap_or_default();
        Classes::from_iter(names)
    }

    fn device(&self) -> Device {
        self.device
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::default()
    }
}

impl AnyStream for PythonStream {
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        call_infer(&self.object, ports, self.ports, self.outputs)
    }

    fn push(&mut self, _: Option<&Ports<'_>>, _: &mut dyn FnMut(Outputs)) -> Result<()> {
        Err(Error::unsupported("a learner written in Python cannot process its input in chunks"))
    }

    fn reset(&mut self) {
        reset(&self.object);
    }
}

/// Resets a Python object. `reset` cannot return an error; Python reports an exception as unraisable.
fn reset(object: &Py<PyAny>) {
    Python::attach(|py| {
        if let Err(raised) = object.call_method0(py, "reset") {
            raised.write_unraisable(py, Some(object.bind(py)));
        }
    });
}

/// Calls `infer` of a Python object with the ports as keyword arguments.
fn call_infer(object: &Py<PyAny>, ports: &Ports<'_>, table: &[Port], outputs: &[Output]) -> Result<Outputs> {
    check_ports(ports, table)?;
    let header =
        table.iter().find_map(|port| ports.get(port.name)).map(|value| value.to_value().header().clone());
    attach(|py| {
        let keywords = PyDict::new(py);
        for port in table {
            if let Some(value) = ports.get(port.name) {
                keywords.set_item(port.name, python_from_value(py, value)?)?;
            }
        }
        let returned = object.call_method(py, "infer", (), Some(&keywords))?.into_bound(py);
        let returned = match returned.cast::<PyTuple>() {
            Ok(several) => several.iter().collect(),
            Err(_) => vec![returned],
        };
        if returned.len() != outputs.len() {
            let (count, expected) = (returned.len(), outputs.len());
            return Err(PyValueError::new_err(format!("infer returned {count} outputs, not {expected}")));
        }
        outputs
            .iter()
            .zip(&returned)
            .map(|(output, object)| {
                let mut value = value_from_python(object, output.value_type)?;
                check_output(&value, output)?;
                if *value.header() == Header::default() {
                    value.header_mut().clone_from(header.as_ref().unwrap_or(&Header::default()));
                }
                Ok((output.name, value))
            })
            .collect()
    })
}

/// Checks that every given port is known and has its type, and that no required port is missing.
fn check_ports(ports: &Ports<'_>, table: &[Port]) -> Result<()> {
    ports.check_names(table)?;
    for port in table {
        let Some(value) = ports.get(port.name) else {
            if port.optional || port.init {
                continue;
            }
            return Err(Error::invalid_input(format!("input {:?} is missing; give it", port.name)));
        };
        if value.value_type() != port.value_type {
            let (expected, given) = (port.value_type.name(), value.value_type().name());
            return Err(Error::invalid_input(format!("input {:?} takes {expected}, not {given}", port.name)));
        }
    }
    Ok(())
}

fn check_output(value: &Value, output: &Output) -> PyResult<()> {
    let given = value.as_value_ref().value_type();
    match given == output.value_type {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!(
            "infer returned a {} as {:?}, which is a {}",
            given.name(),
            output.name,
            output.value_type.name()
        ))),
    }
}
