//! Memory of NumPy arrays: reading theirs, exposing ours.

use std::sync::Arc;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};

/// A NumPy array's memory: address, shape, strides and element type.
///
/// It is valid as long as the caller holds the array: NumPy does not move memory that is referenced elsewhere. Elements
/// are copied out byte by byte through raw pointers, so unaligned elements are allowed, and a concurrent write by
/// another thread leads to a torn image at worst.
pub struct ArrayMemory {
    start: *const u8,
    shape: Vec<usize>,
    /// Bytes from one element to the next along each axis.
    strides: Vec<isize>,
    type_text: String,
}

/// An element type of arrays.
pub trait Element: Copy + Default {
    /// Type string of `__array_interface__`.
    const TYPE_TEXT: &'static str;
}

impl Element for u8 {
    const TYPE_TEXT: &'static str = "|u1";
}

impl Element for u16 {
    const TYPE_TEXT: &'static str = if cfg!(target_endian = "little") { "<u2" } else { ">u2" };
}

impl Element for u32 {
    const TYPE_TEXT: &'static str = if cfg!(target_endian = "little") { "<u4" } else { ">u4" };
}

impl Element for f32 {
    const TYPE_TEXT: &'static str = if cfg!(target_endian = "little") { "<f4" } else { ">f4" };
}

impl Element for f64 {
    const TYPE_TEXT: &'static str = if cfg!(target_endian = "little") { "<f8" } else { ">f8" };
}

impl Element for i64 {
    const TYPE_TEXT: &'static str = if cfg!(target_endian = "little") { "<i8" } else { ">i8" };
}

impl Element for i8 {
    const TYPE_TEXT: &'static str = "|i1";
}

impl ArrayMemory {
    /// Returns the memory of `array`, which must be a NumPy array: the description of other objects is not trusted.
    pub fn of(array: &Bound<'_, PyAny>) -> PyResult<Self> {
        static NDARRAY: PyOnceLock<(Py<PyAny>, Py<PyAny>)> = PyOnceLock::new();
        let py = array.py();
        let (ndarray, describe) = NDARRAY.get_or_try_init(py, || {
            let ndarray = py.import("numpy")?.getattr("ndarray")?;
            let describe = ndarray.getattr("__array_interface__")?.getattr("__get__")?;
            PyResult::Ok((ndarray.unbind(), describe.unbind()))
        })?;
        if !array.is_instance(ndarray.bind(py))? {
            let given = array.get_type().name()?;
            return Err(PyTypeError::new_err(format!("expected a numpy.ndarray, not {given}")));
        }
        // NumPy's own getter, since a subclass may override the attribute.
        let interface = describe.bind(py).call1((array,))?.cast_into::<PyDict>()?;
        let entry = |name: &str| {
            interface
                .get_item(name)?
                .ok_or_else(|| PyTypeError::new_err("the array does not describe its memory"))
        };
        let (address, _): (usize, bool) = entry("data")?.extract()?;
        let shape: Vec<usize> = entry("shape")?.extract()?;
        let type_text: String = entry("typestr")?.extract()?;
        let strides = match entry("strides")?.extract()? {
            Some(strides) => strides,
            None => strides_of_row_major(&shape, &type_text),
        };
        Ok(Self { start: address as *const u8, shape, strides, type_text })
    }

    /// Returns the length of each axis.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Returns whether the elements are of type `T`.
    pub fn is<T: Element>(&self) -> bool {
        self.type_text == T::TYPE_TEXT
    }

    /// Returns NumPy's string for the element type, for error messages.
    pub fn type_text(&self) -> &str {
        &self.type_text
    }

    /// Returns all elements in row-major order.
    pub fn to_vec<T: Element>(&self) -> PyResult<Vec<T>> {
        let mut elements = Vec::new();
        self.copy_into(&mut elements)?;
        Ok(elements)
    }

    /// Copies all elements in row-major order into `elements`, whose memory is reused.
    pub fn copy_into<T: Element>(&self, elements: &mut Vec<T>) -> PyResult<()> {
        if !self.is::<T>() {
            return Err(PyTypeError::new_err(format!(
                "expected an array of {}, not of {}; use astype",
                T::TYPE_TEXT,
                self.type_text
            )));
        }
        copy(self.start, &self.shape, &self.strides, elements)
    }

    /// Copies an image, indexed as `[channels, height, width]`, into `elements`. Keeps the memory layout where it is one of
    /// [`StorageLayout`], else writes HWC. Returns the layout and the shape.
    pub fn copy_image<T: Element>(&self, elements: &mut Vec<T>) -> PyResult<(StorageLayout, [usize; 3])> {
        let (&[channels, height, width], &[channel, row, column]) = (&self.shape[..], &self.strides[..])
        else {
            return Err(PyValueError::new_err(format!(
                "an image has 3 axes (channels, height, width), not the shape {:?}",
                self.shape
            )));
        };
        if !self.is::<T>() {
            return Err(PyTypeError::new_err(format!("expected samples of {}", T::TYPE_TEXT)));
        }
        let shape = [channels, height, width];
        let size = size_of::<T>() as isize;
        let interleaved = column == channels as isize * size;
        // Four reversed channels would be ABGR, which is no pixel format here.
        let reversed = channel == -size && channels == 3;
        if interleaved && (channel == size || reversed) {
            let start = self.start.wrapping_sub(if reversed { 2 * size_of::<T>() } else { 0 });
            copy(start, &[height, width * channels], &[row, size], elements)?;
            return Ok((if reversed { StorageLayout::HwcReversed } else { StorageLayout::Hwc }, shape));
        }
        if column == size {
            copy(self.start, &shape, &self.strides, elements)?;
            return Ok((StorageLayout::Chw, shape));
        }
        copy(self.start, &[height, width, channels], &[row, column, channel], elements)?;
        Ok((StorageLayout::Hwc, shape))
    }
}

/// Returns the strides of a contiguous row-major array, which NumPy omits.
fn strides_of_row_major(shape: &[usize], type_text: &str) -> Vec<isize> {
    // A type string is a byte order, a letter, and the size of an element in bytes.
    let mut stride: isize = type_text.get(2..).and_then(|size| size.parse().ok()).unwrap_or_default();
    let mut strides = vec![0; shape.len()];
    for (place, side) in strides.iter_mut().zip(shape).rev() {
        *place = stride;
        stride = stride.saturating_mul((*side).cast_signed());
    }
    strides
}

/// Memory layout of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageLayout {
    /// `[channels, height, width]`.
    Chw,
    /// `[height, width, channels]`.
    Hwc,
    /// `[height, width, channels]`, in BGR order.
    HwcReversed,
}

fn copy<T: Element>(
    start: *const u8,
    shape: &[usize],
    strides: &[isize],
    elements: &mut Vec<T>,
) -> PyResult<()> {
    let count = shape.iter().try_fold(1usize, |count, &side| count.checked_mul(side));
    let count = count.ok_or_else(|| PyValueError::new_err("the array is too large"))?;
    elements.clear();
    elements
        .try_reserve_exact(count)
        .map_err(|_| PyValueError::new_err(format!("out of memory for {count} elements")))?;
    if count > 0 {
        let (shape, strides) = merged_axes(shape, strides);
        copy_axis(start, &shape, &strides, elements);
    }
    Ok(())
}

/// Merges axes that are contiguous in memory and drops axes of one element.
fn merged_axes(shape: &[usize], strides: &[isize]) -> (Vec<usize>, Vec<isize>) {
    let mut axes: Vec<(usize, isize)> = Vec::with_capacity(shape.len());
    for (&side, &stride) in shape.iter().zip(strides).filter(|(side, _)| **side != 1) {
        match axes.last_mut() {
            Some((outer, apart)) if *apart == side as isize * stride => {
                (*outer, *apart) = (*outer * side, stride)
            }
            _ => axes.push((side, stride)),
        }
    }
    axes.into_iter().unzip()
}

fn copy_axis<T: Element>(start: *const u8, shape: &[usize], strides: &[isize], elements: &mut Vec<T>) {
    let size = size_of::<T>();
    match (shape, strides) {
        (&[side], &[stride]) if stride == size as isize => {
            let filled = elements.len();
            // SAFETY: NumPy guarantees `side` contiguous elements here; capacity for all was reserved; T is
            // a plain number, for which any bytes are valid.
            unsafe {
                let room = elements.as_mut_ptr().add(filled).cast::<u8>();
                std::ptr::copy_nonoverlapping(start, room, side * size);
                elements.set_len(filled + side);
            }
        }
        (&[side], &[stride]) => {
            for index in 0..side as isize {
                // SAFETY: NumPy guarantees an element here; it may be unaligned.
                elements.push(unsafe { start.wrapping_offset(index * stride).cast::<T>().read_unaligned() });
            }
        }
        (&[side, ref shape @ ..], &[stride, ref strides @ ..]) => {
            for index in 0..side as isize {
                copy_axis(start.wrapping_offset(index * stride), shape, strides, elements);
            }
        }
        // No axes: one number.
        _ => {
            // SAFETY: NumPy guarantees an element here; it may be unaligned.
            elements.push(unsafe { start.cast::<T>().read_unaligned() });
        }
    }
}

/// Builds the dictionary of `__array_interface__`; NumPy keeps the object that returns it alive.
pub fn array_interface<'py>(
    py: Python<'py>,
    address: usize,
    shape: &[usize],
    strides: Option<&[isize]>,
    type_text: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let interface = PyDict::new(py);
    let read_only = true;
    interface.set_item("version", 3)?;
    interface.set_item("data", (address, read_only))?;
    interface.set_item("shape", PyTuple::new(py, shape)?)?;
    interface.set_item("typestr", type_text)?;
    if let Some(strides) = strides {
        interface.set_item("strides", PyTuple::new(py, strides)?)?;
    }
    Ok(interface)
}

/// Array of a target, shared with NumPy without a copy: `numpy.asarray(array)`, read-only.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct NativeArray {
    elements: Elements,
    shape: Vec<usize>,
}

enum Elements {
    U32(Arc<Vec<u32>>),
    F32(Arc<Vec<f32>>),
}

impl NativeArray {
    /// Wraps class indices.
    pub fn from_labels(labels: Arc<Vec<u32>>, shape: &[usize]) -> Self {
        Self { elements: Elements::U32(labels), shape: shape.to_vec() }
    }

    /// Wraps scores.
    pub fn from_scores(scores: Arc<Vec<f32>>, shape: &[usize]) -> Self {
        Self { elements: Elements::F32(scores), shape: shape.to_vec() }
    }
}

#[pymethods]
impl NativeArray {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (address, type_text) = match &self.elements {
            Elements::U32(labels) => (labels.as_ptr() as usize, u32::TYPE_TEXT),
            Elements::F32(scores) => (scores.as_ptr() as usize, f32::TYPE_TEXT),
        };
        array_interface(py, address, &self.shape, None, type_text)
    }
}
