//! Observations, the inputs of policies.

use std::ffi::c_char;

use opendr::data::Observation;
use opendr::{Error, Result};

use crate::handle::Out;
use crate::pointer::{place, slice, text};
use crate::status::{guard, guard_value, opendr_status};
use crate::value::{AnyValue, opendr_observation};

/// A named part of an observation.
#[repr(C)]
pub struct opendr_observation_part {
    /// Name of the part.
    pub name: *const c_char,
    /// Numbers in row-major order.
    pub numbers: *const f32,
    /// Count of numbers.
    pub length: usize,
    /// Length of each axis.
    pub shape: *const usize,
    /// Number of axes.
    pub axes: usize,
}

/// Creates an observation without parts from length numbers, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_observation_create(
    numbers: *const f32,
    length: usize,
    observation: *mut *mut opendr_observation,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, numbers) =
            unsafe { (Out::new(observation, "observation")?, slice(numbers, length, "numbers")?) };
        out.set(AnyValue::from(Observation::from_data(numbers.to_vec())?));
        Ok(())
    })
}

/// Creates an observation from named parts, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_observation_create_parts(
    parts: *const opendr_observation_part,
    count: usize,
    observation: *mut *mut opendr_observation,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, parts) = unsafe { (Out::new(observation, "observation")?, slice(parts, count, "parts")?) };
        // SAFETY: the rules at the top of opendr.h.
        let parts = parts.iter().map(|part| unsafe { part.read() }).collect::<Result<Vec<_>>>()?;
        out.set(AnyValue::from(Observation::from_parts(parts)?));
        Ok(())
    })
}

/// Writes a pointer to all numbers of an observation as a flat array, valid as long as the observation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_observation_read(
    observation: *const opendr_observation,
    numbers: *mut *const f32,
    length: *mut usize,
) -> opendr_status {
    guard(|| {
        let (numbers, length) = (place(numbers, "numbers")?, place(length, "length")?);
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            let observation: &Observation = AnyValue::of(observation, "observation")?.typed("observation")?;
            numbers.write(observation.as_slice().as_ptr());
            length.write(observation.as_slice().len());
        }
        Ok(())
    })
}

/// Returns the number of named parts of an observation; 0 if the handle is not an observation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_observation_part_count(observation: *const opendr_observation) -> usize {
    guard_value(0, || {
        // SAFETY: the rules at the top of opendr.h.
        let observation: &Observation =
            unsafe { AnyValue::of(observation, "observation") }?.typed("observation")?;
        Ok(observation.parts().len())
    })
}

/// Writes a part of an observation into part; its pointers are valid as long as the observation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_observation_get(
    observation: *const opendr_observation,
    index: usize,
    part: *mut opendr_observation_part,
) -> opendr_status {
    guard(|| {
        let place = place(part, "part")?;
        // SAFETY: the rules at the top of opendr.h.
        let value = unsafe { AnyValue::of(observation, "observation") }?;
        let observation: &Observation = value.typed("observation")?;
        let (name, shape, numbers) = observation.parts().nth(index).ok_or_else(|| {
            let count = observation.parts().len();
            Error::invalid_input(format!("part {index} is out of range; the observation has {count} parts"))
        })?;
        let part = opendr_observation_part {
            name: value.texts.keep(name),
            numbers: numbers.as_ptr(),
            length: numbers.len(),
            shape: shape.as_ptr(),
            axes: shape.len(),
        };
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(part) };
        Ok(())
    })
}

impl opendr_observation_part {
    /// # Safety
    /// Its pointers are valid.
    unsafe fn read<'a>(&self) -> Result<(&'a str, &'a [usize], &'a [f32])> {
        // SAFETY: the caller's promise.
        unsafe {
            Ok((
                text(self.name, "the name of a part")?,
                slice(self.shape, self.axes, "the shape of a part")?,
                slice(self.numbers, self.length, "the numbers of a part")?,
            ))
        }
    }
}
