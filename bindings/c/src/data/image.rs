//! Images.

use std::ffi::{c_char, c_void};

use opendr::data::{Image, Layout, PixelFormat, Pixels};
use opendr::vision;
use opendr::{Error, Result};

use crate::handle::Out;
use crate::pointer::{path, place, reference, slice};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_image, typed};

/// The sample type of an image.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum opendr_sample_type {
    /// 8 bits, 0 to 255.
    OPENDR_U8 = 0,
    /// 16 bits: depth in millimetres, thermal counts.
    OPENDR_U16 = 1,
    /// Floats: depth in metres, or colours.
    OPENDR_F32 = 2,
}

/// The channels of an image in memory.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum opendr_pixel_format {
    /// One channel: brightness, depth.
    OPENDR_GREY = 0,
    /// Red, green, blue.
    OPENDR_RGB = 1,
    /// Blue, green, red (OpenCV).
    OPENDR_BGR = 2,
    /// Red, green, blue, alpha.
    OPENDR_RGBA = 3,
    /// Blue, green, red, alpha.
    OPENDR_BGRA = 4,
}

/// The order of the axes of an image in memory.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum opendr_layout {
    /// [height, width, channels]: interleaved channels (cameras, OpenCV).
    OPENDR_HWC = 0,
    /// [channels, height, width]: planar channels (networks).
    OPENDR_CHW = 1,
}

use opendr_layout::*;
use opendr_pixel_format::*;
use opendr_sample_type::*;

pub(crate) const FORMATS: [(opendr_pixel_format, PixelFormat); 5] = [
    (OPENDR_GREY, PixelFormat::Grey),
    (OPENDR_RGB, PixelFormat::Rgb),
    (OPENDR_BGR, PixelFormat::Bgr),
    (OPENDR_RGBA, PixelFormat::Rgba),
    (OPENDR_BGRA, PixelFormat::Bgra),
];
pub(crate) const LAYOUTS: [(opendr_layout, Layout); 2] =
    [(OPENDR_HWC, Layout::Hwc), (OPENDR_CHW, Layout::Chw)];

/// Pixels in memory.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_pixels {
    /// The first sample.
    pub data: *const c_void,
    /// Bytes from the first sample to the end of the memory.
    pub size: usize,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Bytes from one row to the next; 0 for contiguous rows. A plane has height rows.
    pub row_stride: usize,
    /// One of opendr_sample_type.
    pub samples: i32,
    /// One of opendr_pixel_format.
    pub format: i32,
    /// One of opendr_layout.
    pub layout: i32,
}

/// Reads an image file: JPEG, PNG, BMP or WebP.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_open(
    path: *const c_char,
    image: *mut *mut opendr_image,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, path) = unsafe { (Out::new(image, "image")?, crate::pointer::path(path, "path")?) };
        out.set(AnyValue::from(vision::open(path)?));
        Ok(())
    })
}

/// Decodes an image from the bytes of a file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_decode(
    bytes: *const u8,
    size: usize,
    image: *mut *mut opendr_image,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, bytes) = unsafe { (Out::new(image, "image")?, slice(bytes, size, "bytes")?) };
        out.set(AnyValue::from(vision::decode(bytes)?));
        Ok(())
    })
}

/// Creates an image from pixels in memory, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_create(
    pixels: *const opendr_pixels,
    image: *mut *mut opendr_image,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, pixels) = unsafe { (Out::new(image, "image")?, reference(pixels, "pixels")?) };
        // SAFETY: the rules at the top of opendr.h.
        out.set(AnyValue::from(unsafe { pixels.to_image() }?));
        Ok(())
    })
}

/// Writes a pointer to the pixels of an image and their format. They are valid as long as the image, and until it is drawn
/// on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_read(
    image: *const opendr_image,
    pixels: *mut opendr_pixels,
) -> opendr_status {
    guard(|| {
        let pixels = place(pixels, "pixels")?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { pixels.write(opendr_pixels::of_image(typed::<Image, _>(image, "image")?)?) };
        Ok(())
    })
}

/// Writes an image file in the format of its extension: .jpg, .png, .bmp or .webp.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_image_save(image: *const opendr_image, path: *const c_char) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (image, path) = unsafe { (typed::<Image, _>(image, "image")?, self::path(path, "path")?) };
        vision::save(image, path)
    })
}

impl opendr_pixels {
    /// # Safety
    /// `data` points to `size` bytes.
    unsafe fn to_image(self) -> Result<Image> {
        let format = from_number(&FORMATS, self.format, |known| *known as i32, "format")?;
        let layout = from_number(&LAYOUTS, self.layout, |known| *known as i32, "layout")?;
        // SAFETY: the caller's promise.
        let bytes = unsafe { slice(self.data.cast::<u8>(), self.size, "the data of pixels") }?;
        let pixels = match self.samples {
            samples if samples == OPENDR_U8 as i32 => {
                Pixels::from(self.packed(bytes, format, layout, |[sample]: [u8; 1]| sample)?)
            }
            samples if samples == OPENDR_U16 as i32 => {
                Pixels::from(self.packed(bytes, format, layout, u16::from_ne_bytes)?)
            }
            samples if samples == OPENDR_F32 as i32 => {
                Pixels::from(self.packed(bytes, format, layout, f32::from_ne_bytes)?)
            }
            other => return Err(unknown("samples", other)),
        };
        Image::new(pixels, self.width, self.height, format, layout)
    }

    /// Returns the samples without gaps between the rows; the source may be unaligned.
    fn packed<T, const N: usize>(
        &self,
        bytes: &[u8],
        format: PixelFormat,
        layout: Layout,
        sample: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>> {
        let (in_row, rows) = match layout {
            Layout::Hwc => (self.width.checked_mul(format.channels()), Some(self.height)),
            Layout::Chw => (Some(self.width), self.height.checked_mul(format.channels())),
        };
        let row = in_row.and_then(|count| count.checked_mul(N)).unwrap_or(usize::MAX);
        let rows = rows.unwrap_or(usize::MAX);
        let stride = if self.row_stride == 0 { row } else { self.row_stride };
        let needed = rows.checked_sub(1).and_then(|gaps| gaps.checked_mul(stride)?.checked_add(row));
        if row == 0 || stride < row || needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(Error::invalid_input(format!(
                "pixels: {} bytes cannot hold {}x{} {format:?} pixels in rows {} bytes apart; give their true size",
                bytes.len(),
                self.width,
                self.height,
                self.row_stride
            )));
        }
        let rows = bytes.chunks(stride).take(rows).filter_map(|line| line.get(..row));
        Ok(rows.flat_map(|line| line.as_chunks::<N>().0).map(|bytes| sample(*bytes)).collect())
    }

    fn of_image(image: &Image) -> Result<Self> {
        let (data, samples, bytes) = match image.pixels() {
            Pixels::U8(data) => (data.as_ptr().cast(), OPENDR_U8, 1),
            Pixels::U16(data) => (data.as_ptr().cast(), OPENDR_U16, 2),
            Pixels::F32(data) => (data.as_ptr().cast(), OPENDR_F32, 4),
        };
        let in_row =
            if image.layout() == Layout::Hwc { image.width() * image.channels() } else { image.width() };
        Ok(Self {
            data,
            size: image.pixels().len() * bytes,
            width: image.width(),
            height: image.height(),
            row_stride: in_row * bytes,
            samples: samples as i32,
            format: to_number(&FORMATS, image.format(), |known| known as i32)?,
            layout: to_number(&LAYOUTS, image.layout(), |known| known as i32)?,
        })
    }
}

/// Returns the entry of a table for a number of C.
///
/// # Errors
/// `InvalidInput` for a number that is not in the table.
pub(crate) fn from_number<C, R: Copy>(
    table: &[(C, R)],
    number: i32,
    number_of: impl Fn(&C) -> i32,
    name: &str,
) -> Result<R> {
    let known = table.iter().find(|(known, _)| number_of(known) == number);
    known.map(|(_, found)| *found).ok_or_else(|| unknown(name, number))
}

fn to_number<C: Copy, R: PartialEq>(table: &[(C, R)], value: R, number_of: impl Fn(C) -> i32) -> Result<i32> {
    let known = table.iter().find(|(_, known)| *known == value);
    known
        .map(|(known, _)| number_of(*known))
        .ok_or_else(|| Error::unsupported("the pixel format or layout is not available in C"))
}

#[cold]
fn unknown(name: &str, number: i32) -> Error {
    Error::invalid_input(format!("{name} of pixels is {number}; give a value of opendr_{name}"))
}
