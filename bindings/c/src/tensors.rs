//! Inputs and outputs of networks.

use std::ffi::{CString, c_char};

use opendr::inference::{TensorData, TensorView};
use opendr::{Error, Result};

use crate::handle::{self, Held};
use crate::pointer::{place, slice};
use crate::status::{guard, guard_value, opendr_status};

/// The outputs of one run of a network.
pub struct opendr_tensors(());

/// A tensor in row-major order.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_tensor {
    /// Name within the network; NULL for an input that is given by position.
    pub name: *const c_char,
    /// The numbers.
    pub numbers: *const f32,
    /// Count of numbers: the product of the shape.
    pub length: usize,
    /// Length of each axis.
    pub shape: *const usize,
    /// Number of axes, at most 8.
    pub axes: usize,
}

impl opendr_tensor {
    /// # Safety
    /// Numbers and shape point to as much memory as their lengths state.
    pub(crate) unsafe fn view<'a>(self) -> Result<TensorView<'a>> {
        // SAFETY: the caller's promise.
        let (numbers, shape) = unsafe {
            (
                slice(self.numbers, self.length, "the numbers of a tensor")?,
                slice(self.shape, self.axes, "the shape of a tensor")?,
            )
        };
        TensorView::new(shape, numbers)
    }
}

/// The value of an [`opendr_tensors`].
#[derive(Default)]
pub(crate) struct Tensors(Vec<Tensor>);

struct Tensor {
    name: CString,
    numbers: Vec<f32>,
    shape: Vec<usize>,
}

impl Held for Tensors {
    const NAME: &'static str = "opendr_tensors";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRtensr");
}

impl Tensors {
    /// Copies a tensor; numbers of other types are converted to floats.
    pub(crate) fn add(&mut self, name: CString, tensor: &TensorView<'_>) -> Result<()> {
        let numbers = match tensor.data() {
            TensorData::F32(numbers) => numbers.to_vec(),
            TensorData::I32(numbers) => numbers.iter().map(|number| *number as f32).collect(),
            TensorData::I64(numbers) => numbers.iter().map(|number| *number as f32).collect(),
            TensorData::U8(numbers) => numbers.iter().map(|number| f32::from(*number)).collect(),
            TensorData::I8(numbers) => numbers.iter().map(|number| f32::from(*number)).collect(),
            TensorData::Bool(numbers) => numbers.iter().map(|number| f32::from(u8::from(*number))).collect(),
            _ => {
                let kind = tensor.element_type();
                return Err(Error::unsupported(format!("an output of {kind} cannot be converted to floats")));
            }
        };
        self.0.push(Tensor { name, numbers, shape: tensor.shape().to_vec() });
        Ok(())
    }
}

/// Returns the number of tensors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tensors_count(tensors: *const opendr_tensors) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || Ok(unsafe { handle::held::<Tensors, _>(tensors, "tensors") }?.0.len()))
}

/// Writes tensor index into tensor; its pointers are valid as long as the tensors. Integers and booleans of a network are
/// converted to floats, with rounding.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tensors_get(
    tensors: *const opendr_tensors,
    index: usize,
    tensor: *mut opendr_tensor,
) -> opendr_status {
    guard(|| {
        let place = place(tensor, "tensor")?;
        // SAFETY: the rules at the top of opendr.h.
        let tensors = unsafe { handle::held::<Tensors, _>(tensors, "tensors") }?;
        let Tensor { name, numbers, shape } = tensors.0.get(index).ok_or_else(|| {
            let count = tensors.0.len();
            Error::invalid_input(format!("tensor {index} is out of range; there are {count} tensors"))
        })?;
        let (name, axes, length) = (name.as_ptr(), shape.len(), numbers.len());
        let tensor = opendr_tensor { name, numbers: numbers.as_ptr(), length, shape: shape.as_ptr(), axes };
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(tensor) };
        Ok(())
    })
}

/// Frees the tensors and sets the variable to NULL; does nothing if it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_tensors_free(tensors: *mut *mut opendr_tensors) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Tensors, _>(tensors, "tensors") })
}
