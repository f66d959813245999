//! Data sets of the toolkit for Python, and data sets of Python for the toolkit.

use std::path::PathBuf;

use opendr::dataset::{Dataset as AnyDataset, DatasetIterator, DatasetRef, ExternalDataset, Sample, Subset};
use opendr::datasets::{OpenOptions, Problems};
use opendr::learner::Port;
use opendr::target::Classes;
use opendr::{Error, Result, ValueType, datasets};
use pyo3::exceptions::{PyIndexError, PyKeyboardInterrupt, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString, PyTuple};

use crate::datum::{python_from_value, value_from_python};
use crate::error::{ToPython, error_from_exception};
use crate::target::target_from_python;

type DataAndTarget<'py> = (Vec<Bound<'py, PyAny>>, Option<Bound<'py, PyAny>>);

/// An opened data set on disk.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Dataset {
    dataset: Box<dyn DatasetIterator>,
    problems: Problems,
}

#[pymethods]
impl Dataset {
    #[new]
    #[pyo3(signature = (path, dataset_type, split=None, target=None, skip_broken=false))]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        dataset_type: &str,
        split: Option<String>,
        target: Option<&str>,
        skip_broken: bool,
    ) -> PyResult<Self> {
        let problems = Problems::new(skip_broken);
        let target = target.map(target_type).transpose().to_python(py)?;
        let external = ExternalDataset::new(path, dataset_type);
        let options = OpenOptions { split, target };
        let dataset = py.detach(|| datasets::open(&external, &options, &problems)).to_python(py)?;
        Ok(Self { dataset, problems })
    }

    fn __len__(&self) -> usize {
        self.dataset.len()
    }

    /// Returns the data of a sample, and its target or `None`.
    fn get<'py>(&self, py: Python<'py>, index: usize) -> PyResult<DataAndTarget<'py>> {
        self.check(index)?;
        let sample = py.detach(|| self.dataset.get(index)).to_python(py)?;
        let data = sample.data.iter().map(|value| python_from_value(py, value.into()));
        let target = sample.target.as_ref().map(|value| python_from_value(py, value.into()));
        Ok((data.collect::<PyResult<_>>()?, target.transpose()?))
    }

    /// Returns the target of a sample or `None`, without reading images where the format allows it.
    fn target<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.check(index)?;
        let target = py.detach(|| self.dataset.target(index)).to_python(py)?;
        target.as_ref().map(|value| python_from_value(py, value.into())).transpose()
    }

    /// Returns the name of a sample in reports.
    fn name(&self, index: usize) -> PyResult<String> {
        self.check(index)?;
        Ok(self.dataset.name(index))
    }

    /// Returns the index of the sequence (video or drive) of a sample, or `None`.
    fn sequence(&self, index: usize) -> PyResult<Option<usize>> {
        self.check(index)?;
        Ok(self.dataset.sequence(index))
    }

    #[getter]
    fn classes(&self) -> Vec<String> {
        self.dataset.classes().iter().map(str::to_owned).collect()
    }

    /// Samples that were skipped as broken, with the reasons.
    #[getter]
    fn problems(&self) -> Vec<String> {
        self.problems.list().iter().map(ToString::to_string).collect()
    }
}

impl Dataset {
    fn check(&self, index: usize) -> PyResult<()> {
        let count = self.dataset.len();
        let missing = || {
            PyIndexError::new_err(format!(
                "sample index {index} is out of range; the data set has {count} samples"
            ))
        };
        (index < count).then_some(()).ok_or_else(missing)
    }
}

/// Returns the sample indices of the two parts of [`Subset::split`]; samples with the same entry in `sequences` stay together.
#[pyfunction]
pub fn split(
    py: Python<'_>,
    sequences: Vec<Option<usize>>,
    share: f64,
    seed: u64,
) -> PyResult<(Vec<usize>, Vec<usize>)> {
    let parts = Subset::split(&Sequences(sequences), share, seed)
        .map(|parts| parts.map(|part| part.indices().to_vec()));
    parts.map(|[first, second]| (first, second)).to_python(py)
}

/// Returns the sample indices in the random order of [`Subset::shuffled`].
#[pyfunction]
pub fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    Subset::shuffled(Sequences(vec![None; count]), seed).indices().to_vec()
}

/// A data set without data, of which only the sequences are known.
struct Sequences(Vec<Option<usize>>);

impl AnyDataset for Sequences {}

impl DatasetIterator for Sequences {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get(&self, _index: usize) -> Result<Sample> {
        Ok(Sample { data: Vec::new(), target: None })
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        self.0.get(index).copied().flatten()
    }
}

/// Returns a table of each data set format.
#[pyfunction]
pub fn formats(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let tables = datasets::formats().iter().map(|format| {
        let table = PyDict::new(py);
        table.set_item("name", format.name)?;
        table.set_item("aliases", format.aliases.to_vec())?;
        table.set_item("about", format.about)?;
        table.set_item("layout", format.layout)?;
        table.set_item("targets", format.targets.iter().map(|target| target.name()).collect::<Vec<_>>())?;
        Ok(table)
    });
    PyList::new(py, tables.collect::<PyResult<Vec<_>>>()?)
}

/// Returns the type of a datum or target, by the name of its class in `opendr.engine`.
pub fn type_of(object: &Bound<'_, PyAny>) -> PyResult<ValueType> {
    for class in object.get_type().mro() {
        let module: String = class.getattr("__module__")?.extract()?;
        let name: String = class.getattr("__qualname__")?.extract()?;
        if let (true, Ok(value_type)) = (module.starts_with("opendr.engine."), name.parse()) {
            return Ok(value_type);
        }
    }
    let class = object.get_type().name()?.to_string();
    Err(PyTypeError::new_err(format!("expected a datum or target of opendr.engine, not {class}")))
}

/// Returns the value types of the ports.
pub fn types_of_ports(ports: &[Port]) -> Vec<ValueType> {
    ports.iter().map(|port| port.value_type).collect()
}

fn target_type(name: &str) -> Result<ValueType> {
    let mut targets = ValueType::ALL.iter().copied().filter(|value_type| value_type.is_target());
    targets.find(|target| target.name() == name).ok_or_else(|| {
        Error::invalid_param(format!("target = {name:?} is not a target type; one is \"BoundingBoxList\""))
    })
}

/// The data set argument of a learner's method.
pub enum GivenDataset {
    /// An `ExternalDataset`.
    External(ExternalDataset),
    /// Any other data set, and the name of its class.
    Samples(PythonDataset, String),
}

impl GivenDataset {
    /// Accepts a path (of a data set whose format is detected), an `ExternalDataset`, or any data set of Python. Its data are
    /// converted to `types`, or by their own classes where `types` is empty.
    pub fn from_python(object: &Bound<'_, PyAny>, types: &[ValueType]) -> PyResult<Self> {
        let external = object.py().import("opendr.engine.datasets")?.getattr("ExternalDataset")?;
        if object.is_instance(&external)? {
            let path: PathBuf = object.getattr("path")?.extract()?;
            let dataset_type: String = object.getattr("dataset_type")?.extract()?;
            return Ok(Self::External(ExternalDataset::new(path, dataset_type)));
        }
        if object.is_instance_of::<PyString>() || object.hasattr("__fspath__")? {
            return Ok(Self::External(ExternalDataset::new(object.extract::<PathBuf>()?, "auto")));
        }
        let class = object.get_type().name()?.to_string();
        Ok(Self::Samples(PythonDataset::new(object, types.to_vec())?, class))
    }

    /// Borrows the data set in the form of the toolkit.
    pub fn as_ref(&self) -> DatasetRef<'_> {
        match self {
            Self::External(external) => DatasetRef::External(external),
            Self::Samples(samples, _) => DatasetRef::Iterator(samples),
        }
    }

    /// Returns the name of the data set in outcomes: its path, or its class.
    pub fn name(&self) -> String {
        match self {
            Self::External(external) => external.path().display().to_string(),
            Self::Samples(_, class) => class.clone(),
        }
    }
}

/// A `DatasetIterator` of Python: `len`, and `[index]` for a pair of datum and target.
pub struct PythonDataset {
    object: Py<PyAny>,
    /// Types of the data of a sample.
    types: Vec<ValueType>,
    length: usize,
    classes: Classes,
}

impl PythonDataset {
    fn new(object: &Bound<'_, PyAny>, types: Vec<ValueType>) -> PyResult<Self> {
        if !object.hasattr("__getitem__")? || !object.hasattr("__len__")? {
            let class = object.get_type().name()?.to_string();
            return Err(PyTypeError::new_err(format!(
                "dataset should be a path, an ExternalDataset or a DatasetIterator, not {class}"
            )));
        }
        let classes =
            object.getattr("classes").ok().and_then(|classes| classes.extract::<Vec<String>>().ok());
        let classes = classes.unwrap_or_default().into_iter().collect();
        Ok(Self { object: object.clone().unbind(), types, length: object.len()?, classes })
    }

    fn read(&self, py: Python<'_>, index: usize) -> PyResult<Sample> {
        let pair = self.object.bind(py).get_item(index)?;
        let (data, target): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract().map_err(|_| {
            PyTypeError::new_err(format!(
                "sample {index} should be a pair of datum and target, not {pair:.200}"
            ))
        })?;
        // A sample of a learner with several inputs has a tuple of data.
        let data = match data.cast::<PyTuple>() {
            Ok(several) => several.iter().collect(),
            Err(_) => vec![data],
        };
        let types = match self.types.is_empty() {
            true => data.iter().map(type_of).collect::<PyResult<_>>()?,
            false => self.types.clone(),
        };
        let values = types.iter().zip(&data).map(|(value_type, datum)| value_from_python(datum, *value_type));
        let target = if target.is_none() { None } else { Some(target_from_python(&target)?) };
        Ok(Sample { data: values.collect::<PyResult<_>>()?, target })
    }

    /// Reads a sample again after Ctrl-C interrupted the read, and raises the interrupt once more, in the main thread: the sample
    /// did not fail, and [`opendr::Progress::stopped`] has to report the interrupt.
    fn read_again(&self, py: Python<'_>, index: usize) -> PyResult<Sample> {
        let sample = self.read(py, index);
        py.import("_thread")?.call_method0("interrupt_main")?;
        sample
    }
}

impl AnyDataset for PythonDataset {}

impl DatasetIterator for PythonDataset {
    fn len(&self) -> usize {
        self.length
    }

    fn get(&self, index: usize) -> Result<Sample> {
        Python::attach(|py| {
            let sample = match self.read(py, index) {
                Err(raised) if raised.is_instance_of::<PyKeyboardInterrupt>(py) => self.read_again(py, index),
                sample => sample,
            };
            sample.map_err(|raised| error_from_exception(py, raised))
        })
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}
