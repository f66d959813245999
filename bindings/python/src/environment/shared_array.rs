//! Memory that NumPy and the toolkit both see.

use std::cell::UnsafeCell;

use opendr::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Element, array_interface};

/// Numbers in native memory that stay where they are: `numpy.asarray(it)` sees them without a copy.
///
/// Observations are written here, for NumPy to read; actions by NumPy, to be read here. Elements are copied through raw
/// pointers, so a thread of the user's that looks meanwhile sees a torn array at worst.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct SharedArray {
    /// Words, so that any element is aligned.
    words: Box<[UnsafeCell<u64>]>,
    number: Number,
    shape: Vec<usize>,
    writable: bool,
}

// SAFETY: the words are touched through raw pointers only, by code that holds no reference to them.
unsafe impl Sync for SharedArray {}

/// What the elements are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// Single precision.
    F32,
    /// Double precision.
    F64,
    /// Bytes.
    U8,
    /// Zeros and ones, in Gymnasium's type for them.
    I8,
    /// Whole numbers.
    I64,
    /// Yes or no.
    Bool,
}

/// The most numbers of an array: 1 GB of the widest.
const MOST: usize = 1 << 27;

impl SharedArray {
    /// Zeros that only the toolkit writes.
    ///
    /// # Errors
    /// `InvalidParam` for more than 2^27 numbers.
    pub fn new(number: Number, shape: Vec<usize>) -> Result<Self> {
        let count = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        let count = count.filter(|count| *count <= MOST).ok_or_else(|| {
            Error::invalid_param(format!("an array of {shape:?} is too large; take fewer environments"))
        })?;
        let words = (count * number.size()).div_ceil(size_of::<u64>());
        Ok(Self { words: (0..words).map(|_| UnsafeCell::new(0)).collect(), number, shape, writable: false })
    }

    /// Zeros that NumPy writes.
    ///
    /// # Errors
    /// As [`Self::new`].
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

    /// Writes doubles from the first element on.
    pub fn write_doubles(&self, numbers: impl Iterator<Item = f64>) {
        self.write_each(0, numbers);
    }

    /// Writes flags from the first element on.
    pub fn write_flags(&self, flags: impl Iterator<Item = bool>) {
        self.write_each(0, flags.map(u8::from));
    }

    /// Reads as many single-precision elements as there is room, from element `at` on.
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
