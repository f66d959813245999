//! Images: reading them from NumPy's memory, exposing them as NumPy's memory, saving, drawing.

use std::path::PathBuf;

use opendr::data::{Image, ImageView, Layout, PixelFormat, Pixels as Samples, Samples as SamplesView};
use opendr::target::Classes;
use opendr::vision::draw::Style;
use opendr::{Value, vision};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::array::{ArrayMemory, Element, StorageLayout, array_interface};
use crate::error::ToPython;
use crate::header::header_from_python;
use crate::target::target_from_python;

/// An image in native memory. `numpy.asarray(pixels)` is a read-only view as `[channels, height, width]`, RGB, without a
/// copy, in any storage layout.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Pixels {
    image: Image,
}

impl Pixels {
    /// Wraps an image. A BGRA image is converted to RGBA: no strides give an RGBA view of it.
    pub fn new(image: Image) -> opendr::Result<Self> {
        if image.format() != PixelFormat::Bgra {
            return Ok(Self { image });
        }
        let pixels = image.hwc_u8(PixelFormat::Rgba);
        let copy = Image::new(pixels, image.width(), image.height(), PixelFormat::Rgba, Layout::Hwc)?;
        Ok(Self { image: copy.with_header(image.header.clone()) })
    }
}

#[pymethods]
impl Pixels {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let view = self.image.view();
        match view.samples() {
            SamplesView::U8(samples) => interface(py, &view, samples),
            SamplesView::U16(samples) => interface(py, &view, samples),
            SamplesView::F32(samples) => interface(py, &view, samples),
        }
    }

    /// `(channels, height, width)`.
    #[getter]
    fn shape(&self) -> (usize, usize, usize) {
        (self.image.channels(), self.image.height(), self.image.width())
    }

    /// Time stamp in nanoseconds, or `None`.
    #[getter]
    fn timestamp(&self) -> Option<i64> {
        self.image.header.stamp_ns
    }

    /// Name of the coordinate frame; empty when unknown.
    #[getter]
    fn frame_id(&self) -> &str {
        self.image.header.frame_id.as_deref().unwrap_or_default()
    }
}

fn interface<'py, T: Element>(
    py: Python<'py>,
    view: &ImageView<'_>,
    samples: &[T],
) -> PyResult<Bound<'py, PyDict>> {
    let size = size_of::<T>() as isize;
    let [row, column, channel] = view.strides().map(|stride| stride as isize * size);
    let [red, green, _] = view.format().rgb_offsets().map(|offset| offset as isize);
    let reversed = green < red;
    let start =
        if reversed { samples.as_ptr().wrapping_offset(red * channel / size) } else { samples.as_ptr() };
    let strides = [if reversed { -channel } else { channel }, row, column];
    let shape = [view.format().channels(), view.height(), view.width()];
    array_interface(py, start as usize, &shape, Some(&strides), T::TYPE_TEXT)
}

/// Converts a Python `Image`. `spare` becomes the memory of an image of bytes.
pub fn image_from_python(object: &Bound<'_, PyAny>, spare: Vec<u8>) -> PyResult<Image> {
    let native = object.getattr("_pixels")?;
    let header = header_from_python(object)?;
    if let Ok(pixels) = native.cast::<Pixels>() {
        return Ok(pixels.get().image.clone().with_header(header));
    }
    let memory = ArrayMemory::of(&object.getattr("data")?)?;
    let image = if memory.is::<u8>() {
        image_of(object.py(), &memory, spare)
    } else if memory.is::<u16>() {
        image_of::<u16>(object.py(), &memory, Vec::new())
    } else if memory.is::<f32>() {
        image_of::<f32>(object.py(), &memory, Vec::new())
    } else {
        let given = memory.type_text();
        Err(PyTypeError::new_err(format!("an image is of uint8, uint16 or float32, not {given}; use astype")))
    };
    Ok(image?.with_header(header))
}

fn image_of<T: Element>(py: Python<'_>, memory: &ArrayMemory, mut samples: Vec<T>) -> PyResult<Image>
where
    Samples: From<Vec<T>>,
{
    let (storage, [channels, height, width]) = memory.copy_image(&mut samples)?;
    let format = match (channels, storage) {
        (1, _) => PixelFormat::Grey,
        (3, StorageLayout::HwcReversed) => PixelFormat::Bgr,
        (3, _) => PixelFormat::Rgb,
        (4, _) => PixelFormat::Rgba,
        _ => return Err(PyValueError::new_err(format!("an image has 1, 3 or 4 channels, not {channels}"))),
    };
    let layout = if storage == StorageLayout::Chw { Layout::Chw } else { Layout::Hwc };
    Image::new(samples, width, height, format, layout).to_python(py)
}

/// Converts an image to a Python `Image`.
pub fn python_from_image(py: Python<'_>, image: Image) -> PyResult<Bound<'_, PyAny>> {
    let pixels = Pixels::new(image).to_python(py)?;
    py.import("opendr._schema")?.call_method1("image_from_pixels", (pixels,))
}

/// Writes a Python `Image` to a file in the format of the extension.
#[pyfunction]
pub fn save_image(py: Python<'_>, image: &Bound<'_, PyAny>, path: PathBuf) -> PyResult<()> {
    let image = image_from_python(image, Vec::new())?;
    py.detach(|| vision::save(&image, path)).to_python(py)
}

/// Returns the bytes of a PNG file of a Python `Image`.
#[pyfunction]
pub fn png<'py>(image: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyBytes>> {
    let py = image.py();
    let image = image_from_python(image, Vec::new())?;
    let file = py.detach(|| vision::encode_png(&image)).to_python(py)?;
    Ok(PyBytes::new(py, &file))
}

/// Returns a Python `Image` with a target drawn on it; `class_names` replace those of the target.
#[pyfunction]
#[pyo3(signature = (image, target, class_names=None))]
pub fn draw<'py>(
    image: &Bound<'py, PyAny>,
    target: &Bound<'py, PyAny>,
    class_names: Option<Vec<String>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = image.py();
    let mut canvas = image_from_python(image, Vec::new())?;
    let mut target = target_from_python(target)?;
    if let Some(names) = class_names {
        let classes = Classes::from_iter(names);
        match &mut target {
            Value::BoundingBoxList(list) => list.classes = classes,
            Value::TrackingAnnotationList(list) => list.classes = classes,
            Value::Heatmap(map) => map.classes = classes,
            Value::Category(category) => {
                category.description = classes.name(category.class).cloned().or(category.description.take());
            }
            _ => {}
        }
    }
    py.detach(|| vision::draw::draw(&mut canvas, target.as_value_ref(), &Style::default()));
    python_from_image(py, canvas)
}
