//! Data that are one array: point clouds, time series, vectors, videos, skeleton sequences.

use std::ffi::c_char;

use opendr::data::{PointCloud, SkeletonSequence, Timeseries, Vector, Video};
use opendr::{Error, Result, Value, ValueType};

use crate::handle::Out;
use crate::pointer::{place, slice, text};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_value};

/// The types that are one array, and the names of their axes.
pub const ARRAYS: [(ValueType, &[&str]); 5] = [
    (ValueType::Video, &["channels", "time", "height", "width"]),
    (ValueType::PointCloud, &["points", "channels"]),
    (ValueType::Timeseries, &["time", "features"]),
    (ValueType::Vector, &["features"]),
    (ValueType::SkeletonSequence, &["samples", "channels", "frames", "joints", "persons"]),
];

/// Creates a datum of the named type ("Vector", "PointCloud", ...) from length numbers in row-major order, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_array_create(
    type_name: *const c_char,
    numbers: *const f32,
    length: usize,
    shape: *const usize,
    axes: usize,
    value: *mut *mut opendr_value,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, kind, shape) = unsafe {
            (Out::new(value, "value")?, text(type_name, "type_name")?.parse()?, slice(shape, axes, "shape")?)
        };
        let expected = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if expected != Some(length) {
            return Err(Error::invalid_input(format!(
                "an array of shape {shape:?} cannot have {length} numbers; give one per element"
            )));
        }
        // SAFETY: the rules at the top of opendr.h.
        let numbers = unsafe { slice(numbers, length, "numbers") }?;
        out.set(AnyValue::from(value_from_numbers(kind, numbers.to_vec(), shape)?));
        Ok(())
    })
}

/// Writes a pointer to the numbers of such a datum and the lengths of its axes; shape has room for axes lengths, the number
/// of axes of the type. The numbers are valid as long as the datum.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_array_read(
    value: *const opendr_value,
    numbers: *mut *const f32,
    length: *mut usize,
    shape: *mut usize,
    axes: usize,
) -> opendr_status {
    guard(|| {
        let (numbers, length, shape) =
            (place(numbers, "numbers")?, place(length, "length")?, place(shape, "shape")?);
        // SAFETY: the rules at the top of opendr.h.
        let (data, sizes) = numbers_of_value(&unsafe { AnyValue::of(value, "value") }?.value)?;
        if sizes.len() != axes {
            return Err(Error::invalid_input(format!(
                "the datum has {} axes, and shape has room for {axes}; give room for all",
                sizes.len()
            )));
        }
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            numbers.write(data.as_ptr());
            length.write(data.len());
            sizes.iter().enumerate().for_each(|(axis, size)| shape.add(axis).write(*size));
        }
        Ok(())
    })
}

fn value_from_numbers(kind: ValueType, numbers: Vec<f32>, shape: &[usize]) -> Result<Value> {
    Ok(match kind {
        ValueType::PointCloud => PointCloud::new(numbers, fixed(kind, shape)?)?.into(),
        ValueType::Timeseries => Timeseries::new(numbers, fixed(kind, shape)?)?.into(),
        ValueType::Vector => Vector::new(numbers, fixed(kind, shape)?)?.into(),
        ValueType::Video => Video::new(numbers, fixed(kind, shape)?)?.into(),
        ValueType::SkeletonSequence => SkeletonSequence::new(numbers, fixed(kind, shape)?)?.into(),
        other => return Err(no_array(other)),
    })
}

fn numbers_of_value(value: &Value) -> Result<(&[f32], Vec<usize>)> {
    Ok(match value {
        Value::PointCloud(datum) => (datum.as_slice(), datum.shape().to_vec()),
        Value::Timeseries(datum) => (datum.as_slice(), datum.shape().to_vec()),
        Value::Vector(datum) => (datum.as_slice(), datum.shape().to_vec()),
        Value::Video(datum) => (datum.as_slice(), datum.shape().to_vec()),
        Value::SkeletonSequence(datum) => (datum.as_slice(), datum.shape().to_vec()),
        other => return Err(no_array(other.as_value_ref().value_type())),
    })
}

fn fixed<const D: usize>(kind: ValueType, shape: &[usize]) -> Result<[usize; D]> {
    shape.try_into().map_err(|_| {
        Error::invalid_input(format!(
            "a {} has {D} axes, not {}; give the length of each",
            kind.name(),
            shape.len()
        ))
    })
}

#[cold]
fn no_array(kind: ValueType) -> Error {
    let names: Vec<_> = ARRAYS.iter().map(|(known, _)| known.name()).collect();
    Error::invalid_input(format!("a {} is not an array; arrays are {}", kind.name(), names.join(", ")))
}
