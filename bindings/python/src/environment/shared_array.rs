//! Memory that NumPy and the toolkit share.

use std::cell::UnsafeCell;

use opendr::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Element, array_interface};

/// An array at a fixed address in native memory; `numpy.asarray(array)` is a view of it.
///
/// The toolkit writes observations for NumPy to read; NumPy writes actions for the toolkit to read. Elements are copied through
/// raw pointers, so a thread that reads meanwhile gets a torn array at worst.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct SharedArray {
    /// Memory in words of 8 bytes, so that every element type is aligned.
    words: Box<[UnsafeCell<u64>]>,
    number: Number,
    shape: Vec<usize>,
    writable: bool,
}

// SAFETY: the words are accessed through raw pointers only; no reference to them exists.
unsafe impl Sync for SharedArray {}

/// Element type of a shared array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// float32.
    F32,
    /// float64.
    F64,
    /// uint8.
    U8,
    /// int8, Gymnasium's type of zeros and ones (`MultiBinary`).
    I8,
    /// int64.
    I64,
    /// bool.
    Bool,
}

/// Maximum number of elements of an array: 1 GiB of the widest type.
const MAX_ELEMENTS: usize = 1 << 27;

impl SharedArray {
    /// Creates an array of zeros that NumPy cannot write.
    ///
    /// # Errors
    /// `InvalidParam` for more than 2^27 numbers.
    pub fn new(number: Number, shape: Vec<usize>) -> Result<Self> {
        let count = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        let count = count.filter(|count| *count <= MAX_ELEMENTS).ok_or_else(|| {
            Error::invalid_param(format!("an array of {shape:?} is too large; take fewer environments"))
        })?;
        let words = (count * number.size()).div_ceil(size_of::<u64>());
        Ok(Self { words: (0..words).map(|_| UnsafeCell::new(0)).collect(), number, shape, writable: false })
    }

    /// Creates an array of zeros that NumPy can write.
    ///
    /// # Errors
    /// The same as [`Self::new`].
    pub fn writable(number: Number, shape: Vec<usize>) -> Result<Self> {
        Ok(Self { writable: true, ..Self::new(number, shape)? })
    }

    /// Writes numbers as elements, from element `at` on.
    pub fn write(&self, at: usize, numbers: &[f32]) {
        match self.number {
            Number::F32 => self.write_each(at, numbers.iter().copied()),
            Number::F64 => self.write_each(at, numbers.iter().copied().map(f64::from)),
            Number::U8 => self.write_each(at, numbers.iter().map(|number| *number as u8)),
            Number::I8 => self.write_each(at, numbers.iter().map(|number| *number as i8)),
            Number::I64 => self.write_each(at, numbers.iter().map(|number| *number as i64)),
            Number::Bool => self.write_flags(numbers.iter().map(|number| *number != 0.0)),
        }
    }

    /// Writes float64 elements from the first element on.
    pub fn write_doubles(&self, numbers: impl Iterator<Item = f64>) {
        self.write_each(0, numbers);
    }

    /// Writes flags from the first element on.
    pub fn write_flags(&self, flags: impl Iterator<Item = bool>) {
        self.write_each(0, flags.map(u8::from));
    }

    /// Reads float32 elements from element `at` on, at most as many as the array has.
    pub fn read(&self, at: usize, numbers: &mut [f32]) {
        let count = numbers.len().min(self.room::<f32>().saturating_sub(at));
        // SAFETY: `count` elements from `at` on lie within the words; any bytes are a number.
        unsafe {
            std::ptr::copy_nonoverlapping(self.start::<f32>().add(at), numbers.as_mut_ptr(), count);
        }
    }

    fn write_each<T: Element>(&self, at: usize, elements: impl Iterator<Item = T>) {
        let room = self.room::<T>().saturating_sub(at);
        let start = self.start::<T>();
        for (index, element) in elements.take(room).enumerate() {
            // SAFETY: element `at + index` lies within the words.
            unsafe { start.add(at + index).write(element) };
        }
    }

    fn room<T>(&self) -> usize {
        size_of_val(&*self.words) / size_of::<T>()
    }

    fn start<T>(&self) -> *mut T {
        self.words.as_ptr().cast_mut().cast()
    }
}

impl Number {
    const fn size(self) -> usize {
        match self {
            Self::U8 | Self::I8 | Self::Bool => 1,
            Self::F32 => 4,
            Self::F64 | Self::I64 => 8,
        }
    }

    const fn type_text(self) -> &'static str {
        match self {
            Self::F32 => f32::TYPE_TEXT,
            Self::F64 => f64::TYPE_TEXT,
            Self::U8 => u8::TYPE_TEXT,
            Self::I8 => i8::TYPE_TEXT,
            Self::I64 => i64::TYPE_TEXT,
            Self::Bool => "|b1",
        }
    }
}

#[pymethods]
impl SharedArray {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let address = self.start::<u8>() as usize;
        let interface = array_interface(py, address, &self.shape, None, self.number.type_text())?;
        interface.set_item("data", (address, !self.writable))?;
        Ok(interface)
    }
}
