//! Data that are numbers along axes: point clouds, time series, vectors, videos, skeletons.

use std::ffi::c_char;

use opendr::data::{PointCloud, SkeletonSequence, Timeseries, Vector, Video};
use opendr::{Error, Result, Value, ValueType};

use crate::handle::Out;
use crate::pointer::{place, slice, text};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_value};

/// The types that are numbers along axes, and what the axes are.
pub const ARRAYS: [(ValueType, &[&str]); 5] = [
    (ValueType::Video, &["channels", "time", "height", "width"]),
    (ValueType::PointCloud, &["points", "channels"]),
    (ValueType::Timeseries, &["time", "features"]),
    (ValueType::Vector, &["features"]),
    (ValueType::SkeletonSequence, &["samples", "channels", "frames", "joints", "persons"]),
];

/// Makes a datum of the named type ("Vector", "PointCloud", ...) of length numbers, which are copied, last axis fastest.
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
        let wanted = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if wanted != Some(length) {
            return Err(Error::invalid_input(format!(
                "an array of shape {shape:?} cannot have {length} numbers; give one per place"
            )));
        }
        // SAFETY: the rules at the top of opendr.h.
        let numbers = unsafe { slice(numbers, length, "numbers") }?;
        out.set(AnyValue::from(value_from_numbers(kind, numbers.to_vec(), shape)?));
        Ok(())
    })
}

/// Shows the numbers of such a datum and the sizes of its axes; shape has room for axes sizes, as many as the type has.
/// The numbers live as long as the datum.
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
                "{} axes do not fit into {axes}; give room for them",
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
            "a {} has {D} axes, not {}; give the size of each",
            kind.name(),
            shape.len()
        ))
    })
}

#[cold]
fn no_array(kind: ValueType) -> Error {
    let names: Vec<_> = ARRAYS.iter().map(|(known, _)| known.name()).collect();
    Error::invalid_input(format!("a {} is no array; arrays are {}", kind.name(), names.join(", ")))
}
