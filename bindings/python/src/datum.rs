//! Conversion of data between the toolkit and Python objects that own NumPy arrays.

use std::path::PathBuf;

use opendr::data::{
    Audio, Calibration, ImageWithDetections, Observation, PointCloud, PointCloudWithCalibration,
    SkeletonSequence, Timeseries, Vector, Video,
};
use opendr::{Error, Result, Value, ValueRef, ValueType};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{ArrayMemory, NativeArray};
use crate::error::ToPython;
use crate::header::header_from_python;
use crate::pixels::{image_from_python, python_from_image};
use crate::target::{python_from_target, target_from_python};

/// Converts a Python object to a value of type `value_type`.
pub fn value_from_python(object: &Bound<'_, PyAny>, value_type: ValueType) -> PyResult<Value> {
    if value_type.is_target() {
        return target_from_python(object);
    }
    let py = object.py();
    let numbers = || Numbers::of(&object.getattr("data")?);
    let mut value = match value_type {
        ValueType::Image => return image_from_python(object, Vec::new()).map(Value::Image),
        ValueType::Video => Value::Video(numbers()?.datum(Video::new)?),
        ValueType::PointCloud => Value::PointCloud(numbers()?.datum(PointCloud::new)?),
        ValueType::Timeseries => Value::Timeseries(numbers()?.datum(Timeseries::new)?),
        ValueType::Vector => Value::Vector(numbers()?.datum(Vector::new)?),
        ValueType::SkeletonSequence => Value::SkeletonSequence(numbers()?.datum(SkeletonSequence::new)?),
        // A time series has no sample rate.
        ValueType::Audio if !object.hasattr("sample_rate")? => {
            Value::Timeseries(numbers()?.datum(Timeseries::new)?)
        }
        ValueType::Audio => Value::Audio(audio(object)?),
        ValueType::Calibration => Value::Calibration(calibration(object)?),
        ValueType::Observation => Value::Observation(observation(object)?),
        ValueType::PointCloudWithCalibration => {
            let cloud = numbers()?.datum(PointCloud::new)?;
            let matrices = object.getattr("calibration")?;
            if matrices.is_none() {
                return Err(PyValueError::new_err("the cloud has no calibration; give calib"));
            }
            let calibration = calibration(&matrices)?;
            let image_shape = object.getattr("image_shape")?.extract()?;
            Value::PointCloudWithCalibration(PointCloudWithCalibration::new(cloud, calibration, image_shape))
        }
        ValueType::ImageWithDetections => {
            let image = image_from_python(object, Vec::new())?;
            let Value::BoundingBoxList(boxes) = target_from_python(&object.getattr("boundingBoxList")?)?
            else {
                return Err(PyTypeError::new_err("boundingBoxList should be a BoundingBoxList"));
            };
            Value::ImageWithDetections(ImageWithDetections::new(image, boxes))
        }
        other => {
            return Err(Error::unsupported(format!("{} cannot be converted from Python", other.name())))
                .to_python(py);
        }
    };
    *value.header_mut() = header_from_python(object)?;
    Ok(value)
}

/// Reads a value of the type called `kind` from a file.
#[pyfunction]
pub fn open_value<'py>(py: Python<'py>, kind: &str, path: PathBuf) -> PyResult<Bound<'py, PyAny>> {
    let kind: ValueType = kind.parse().to_python(py)?;
    let value = py.detach(|| opendr::datasets::open_value(kind, path)).to_python(py)?;
    python_from_value(py, value.as_value_ref())
}

/// Converts a value to its Python object.
pub fn python_from_value<'py>(py: Python<'py>, value: ValueRef<'_>) -> PyResult<Bound<'py, PyAny>> {
    let name = value.value_type().name();
    let array = |numbers: &[f32], shape: &[usize]| NativeArray::from_scores(numbers.to_vec().into(), shape);
    // The arguments of the constructor in Python.
    let parts = match value {
        ValueRef::Image(image) => return python_from_image(py, image.clone()),
        ValueRef::Video(data) => (array(data.as_slice(), &data.shape()),).into_pyobject(py)?,
        ValueRef::PointCloud(data) => (array(data.as_slice(), &data.shape()),).into_pyobject(py)?,
        ValueRef::Timeseries(data) => (array(data.as_slice(), &data.shape()),).into_pyobject(py)?,
        ValueRef::Vector(data) => (array(data.as_slice(), &data.shape()),).into_pyobject(py)?,
        ValueRef::SkeletonSequence(data) => (array(data.as_slice(), &data.shape()),).into_pyobject(py)?,
        ValueRef::Audio(audio) => {
            (array(audio.as_slice(), &audio.array().shape()), audio.sample_rate()).into_pyobject(py)?
        }
        ValueRef::Calibration(matrices) => {
            (matrices.p2, matrices.r0_rect, matrices.tr_velo_to_cam).into_pyobject(py)?
        }
        ValueRef::Observation(data) if data.parts().len() == 0 => {
            (array(data.as_slice(), &[data.as_slice().len()]),).into_pyobject(py)?
        }
        ValueRef::Observation(data) => {
            let parts = PyDict::new(py);
            for (part, shape, numbers) in data.parts() {
                parts.set_item(part, array(numbers, shape))?;
            }
            (parts,).into_pyobject(py)?
        }
        ValueRef::ImageWithDetections(data) => {
            let boxes = python_from_target(py, &Value::BoundingBoxList(data.boxes.clone()))?;
            (python_from_image(py, data.image.clone())?, boxes).into_pyobject(py)?
        }
        ValueRef::PointCloudWithCalibration(data) => {
            let cloud = array(data.cloud.as_slice(), &data.cloud.shape());
            let calibration = python_from_value(py, ValueRef::Calibration(&data.calibration))?;
            (cloud, calibration, data.image_shape).into_pyobject(py)?
        }
        target if target.value_type().is_target() => return python_from_target(py, &target.to_value()),
        _ => return Err(Error::unsupported(format!("{name} cannot be converted to Python"))).to_python(py),
    };
    let value = value.to_value();
    let header = value.header();
    let schema = py.import("opendr._schema")?;
    schema.call_method1("datum_from_parts", (name, parts, header.stamp_ns, header.frame_id.as_deref()))
}

/// The elements of an array of floats.
struct Numbers<'py> {
    py: Python<'py>,
    shape: Vec<usize>,
    elements: Vec<f32>,
}

impl<'py> Numbers<'py> {
    fn of(array: &Bound<'py, PyAny>) -> PyResult<Self> {
        let memory = ArrayMemory::of(array)?;
        Ok(Self { py: array.py(), shape: memory.shape().to_vec(), elements: memory.to_vec()? })
    }

    fn datum<T, const D: usize>(self, make: impl FnOnce(Vec<f32>, [usize; D]) -> Result<T>) -> PyResult<T> {
        let shape = <[usize; D]>::try_from(self.shape).map_err(|shape| {
            PyValueError::new_err(format!("expected an array of {D} axes, not one of shape {shape:?}"))
        })?;
        make(self.elements, shape).to_python(self.py)
    }
}

fn audio(object: &Bound<'_, PyAny>) -> PyResult<Audio> {
    let samples = Numbers::of(&object.getattr("data")?)?;
    let sample_rate = object.getattr("sample_rate")?.extract()?;
    samples.datum(|elements, [_, channels]: [usize; 2]| Audio::new(elements, channels, sample_rate))
}

fn calibration(object: &Bound<'_, PyAny>) -> PyResult<Calibration> {
    Ok(Calibration {
        header: header_from_python(object)?,
        p2: matrix(object, "p2")?,
        r0_rect: matrix(object, "r0_rect")?,
        tr_velo_to_cam: matrix(object, "tr_velo_to_cam")?,
    })
}

/// Reads a matrix from an attribute, which users may have set to anything.
fn matrix<const COLUMNS: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<[[f64; COLUMNS]; 3]> {
    let numpy = object.py().import("numpy")?;
    let rows = numpy.call_method1("asarray", (object.getattr(name)?,))?.call_method0("tolist")?;
    let rows = rows.extract::<[[f64; COLUMNS]; 3]>().ok();
    rows.filter(|rows| rows.as_flattened().iter().all(|number| number.is_finite()))
        .ok_or_else(|| PyValueError::new_err(format!("{name} should be 3 rows of {COLUMNS} finite numbers")))
}

/// Reads an observation from one array, or from a dictionary of arrays by name.
fn observation(object: &Bound<'_, PyAny>) -> PyResult<Observation> {
    let py = object.py();
    let data = object.getattr("data")?;
    let Ok(parts) = data.cast::<PyDict>() else {
        return Observation::from_data(Numbers::of(&data)?.elements).to_python(py);
    };
    let mut read = Vec::with_capacity(parts.len());
    for (name, array) in parts.iter() {
        read.push((name.extract::<String>()?, Numbers::of(&array)?));
    }
    let parts = read.iter().map(|(name, numbers)| (name.as_str(), &numbers.shape[..], &numbers.elements[..]));
    Observation::from_parts(parts).to_python(py)
}
