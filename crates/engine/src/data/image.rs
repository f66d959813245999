//! Images. Users receive CHW RGB `u8`; the storage may have any layout, so that camera frames are not transposed
//! needlessly.

use std::fmt;
use std::sync::Arc;

use crate::data::image_view::{ImageView, Samples};
use crate::data::pixel_format::PixelFormat;
use crate::numpy_text::{Number, array_str};
use crate::{Error, Header, Result};

/// Order of the axes in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Layout {
    /// `[height, width, channels]`: the channels of a pixel are adjacent (cameras, decoders, OpenCV).
    Hwc,
    /// `[channels, height, width]`: each channel is a plane (networks, OpenDR's `numpy()`).
    Chw,
}

/// The samples of an image. Clones of an [`Image`] share them.
#[derive(Debug, Clone, PartialEq)]
pub enum Pixels {
    /// 8 bits per sample, 0..=255.
    U8(Arc<Vec<u8>>),
    /// 16 bits per sample: depth in millimetres, thermal counts.
    U16(Arc<Vec<u16>>),
    /// Floats: depth in metres, or colours in the range of their source.
    F32(Arc<Vec<f32>>),
}

impl Pixels {
    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(data) => data.len(),
            Self::U16(data) => data.len(),
            Self::F32(data) => data.len(),
        }
    }

    /// Returns whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl From<Vec<u8>> for Pixels {
    fn from(data: Vec<u8>) -> Self {
        Self::U8(Arc::new(data))
    }
}

impl From<Vec<u16>> for Pixels {
    fn from(data: Vec<u16>) -> Self {
        Self::U16(Arc::new(data))
    }
}

impl From<Vec<f32>> for Pixels {
    fn from(data: Vec<f32>) -> Self {
        Self::F32(Arc::new(data))
    }
}

/// An image with time stamp and frame id. Clones share the pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Time stamp and coordinate frame.
    pub header: Header,
    pixels: Pixels,
    width: usize,
    height: usize,
    format: PixelFormat,
    layout: Layout,
}

impl Image {
    /// Creates an image of `width` x `height` pixels over samples in the given `format` and `layout`.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the number of samples is not `width * height * channels`, or a side is 0.
    pub fn new(
        pixels: impl Into<Pixels>,
        width: usize,
        height: usize,
        format: PixelFormat,
        layout: Layout,
    ) -> Result<Self> {
        let pixels = pixels.into();
        let expected = width.checked_mul(height).and_then(|area| area.checked_mul(format.channels()));
        if expected != Some(pixels.len()) || pixels.is_empty() {
            return Err(Error::invalid_input(format!(
                "a {width}x{height} {format:?} image needs {} samples, not {}; give at least one pixel",
                expected.map_or_else(|| "too many".to_owned(), |count| count.to_string()),
                pixels.len(),
            )));
        }
        Ok(Self { header: Header::default(), pixels, width, height, format, layout })
    }

    /// Creates a `u8` image from `[height, width, 3]` RGB bytes.
    ///
    /// # Errors
    /// Returns `InvalidInput` if there are not `width * height * 3` bytes.
    pub fn from_rgb8(data: Vec<u8>, width: usize, height: usize) -> Result<Self> {
        Self::new(data, width, height, PixelFormat::Rgb, Layout::Hwc)
    }

    /// Sets the header.
    #[must_use]
    pub fn with_header(mut self, header: Header) -> Self {
        self.header = header;
        self
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the order of the channels in memory.
    pub fn format(&self) -> PixelFormat {
        self.format
    }

    /// Returns the order of the axes in memory.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Returns the number of channels.
    pub fn channels(&self) -> usize {
        self.format.channels()
    }

    /// Returns the samples as stored.
    pub fn pixels(&self) -> &Pixels {
        &self.pixels
    }

    /// Returns the `u8` samples for modification; they are copied first if another [`Image`] shares them. Returns `None` if
    /// the samples are of another type.
    pub fn bytes_mut(&mut self) -> Option<&mut [u8]> {
        match &mut self.pixels {
            Pixels::U8(data) => Some(Arc::make_mut(data).as_mut_slice()),
            _ => None,
        }
    }

    /// Returns the samples, for sources that reuse the buffer.
    pub fn into_pixels(self) -> Pixels {
        self.pixels
    }

    /// Returns a strided view of the image, the input of kernels.
    pub fn view(&self) -> ImageView<'_> {
        let samples = match &self.pixels {
            Pixels::U8(data) => Samples::U8(data),
            Pixels::U16(data) => Samples::U16(data),
            Pixels::F32(data) => Samples::F32(data),
        };
        let (row, column, channel) = match self.layout {
            Layout::Hwc => (self.width * self.channels(), self.channels(), 1),
            Layout::Chw => (self.width, 1, self.width * self.height),
        };
        ImageView::from_parts(samples, self.width, self.height, self.format, [row, column, channel])
    }

    /// Returns a `u8` copy as `[height, width, channels]` in `format` (OpenCV's images are `Bgr`).
    ///
    /// Grey is copied to all three channels, opacity is dropped or set to 255, `u16` and `f32` samples are scaled as by
    /// [`ImageView::sample_u8`].
    pub fn hwc_u8(&self, format: PixelFormat) -> Vec<u8> {
        self.view().hwc_u8(format)
    }

    /// Returns a `u8` copy as `[channels, height, width]`, RGB (grey images keep one channel): OpenDR's `Image.numpy()`.
    pub fn chw_u8(&self) -> Vec<u8> {
        self.view().chw_u8()
    }

    /// Guesses the layout of an array from its shape, as OpenDR does: last axis 3 means HWC **BGR** (OpenCV), another last
    /// axis smaller than both others means HWC RGB, everything else CHW RGB.
    ///
    /// Returns layout, format, width and height of a `[a, b, c]` array.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the number of channels is not 1, 3 or 4.
    pub fn guess_format(shape: [usize; 3]) -> Result<(Layout, PixelFormat, usize, usize)> {
        let [a, b, c] = shape;
        let (layout, channels, width, height) =
            if c == 3 || c < a.min(b) { (Layout::Hwc, c, b, a) } else { (Layout::Chw, a, c, b) };
        let format = match (channels, layout) {
            (1, _) => PixelFormat::Grey,
            (3, Layout::Hwc) => PixelFormat::Bgr,
            (3, Layout::Chw) => PixelFormat::Rgb,
            (4, _) => PixelFormat::Rgba,
            _ => {
                return Err(Error::invalid_input(format!(
                    "an array of shape {shape:?} is not an image; the first or last axis must have 1, 3 or 4 channels"
                )));
            }
        };
        Ok((layout, format, width, height))
    }
}

impl crate::data::Data for Image {}

/// Writes OpenDR's text: `[channels, height, width]`, RGB, as NumPy prints it; with `{:#}`, size, channels and sample type.
impl fmt::Display for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height, format) = (self.width, self.height, self.format);
        if f.alternate() {
            let samples = match self.pixels {
                Pixels::U8(_) => "u8",
                Pixels::U16(_) => "u16",
                Pixels::F32(_) => "f32",
            };
            return writeln!(f, "{width}x{height} image, {format:?}, {samples}");
        }
        let [row, column, channel] = self.view().strides();
        let [red, green, blue] = format.rgb_offsets();
        let number = |at: usize| {
            let (plane, y, x) = (at / (width * height), at / width % height, at % width);
            let plane = [red, green, blue, 3][plane];
            let at = y * row + x * column + plane * channel;
            match &self.pixels {
                Pixels::U8(data) => Number::Int(data[at].into()),
                Pixels::U16(data) => Number::Int(data[at].into()),
                Pixels::F32(data) => Number::F32(data[at]),
            }
        };
        f.write_str(&array_str(&[self.channels(), height, width], &number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn storage_layout_does_not_affect_output() {
        // Two pixels: red-ish and blue-ish.
        let rgb = Image::from_rgb8(vec![1, 2, 3, 4, 5, 6], 2, 1).unwrap();
        let bgr = Image::new(vec![3u8, 2, 1, 6, 5, 4], 2, 1, PixelFormat::Bgr, Layout::Hwc).unwrap();
        let chw = Image::new(vec![1u8, 4, 2, 5, 3, 6], 2, 1, PixelFormat::Rgb, Layout::Chw).unwrap();
        for image in [&rgb, &bgr, &chw] {
            assert_eq!(image.chw_u8(), [1, 4, 2, 5, 3, 6]);
            assert_eq!(image.hwc_u8(PixelFormat::Bgr), [3, 2, 1, 6, 5, 4]);
            assert_eq!(image.to_string(), "[[[1 4]]\n\n [[2 5]]\n\n [[3 6]]]");
            assert_eq!(image.hwc_u8(PixelFormat::Rgba), [1, 2, 3, 255, 4, 5, 6, 255]);
        }
    }

    #[test]
    fn modification_in_place_keeps_clones() {
        let mut image = Image::from_rgb8(vec![1, 2, 3], 1, 1).unwrap();
        let before = image.clone();
        image.bytes_mut().unwrap()[0] = 9;
        assert_eq!((image.chw_u8(), before.chw_u8()), (vec![9, 2, 3], vec![1, 2, 3]));
        let mut depth = Image::new(vec![1.0f32], 1, 1, PixelFormat::Grey, Layout::Hwc).unwrap();
        assert!(depth.bytes_mut().is_none());
    }

    #[test]
    fn wrong_number_of_samples_is_rejected() {
        assert!(Image::from_rgb8(vec![0; 5], 2, 1).is_err());
        assert!(Image::from_rgb8(Vec::new(), 0, 0).is_err());
        assert!(Image::from_rgb8(vec![0; 3], usize::MAX, usize::MAX).is_err());
    }

    #[test]
    fn guess_is_that_of_opendr() {
        assert_eq!(Image::guess_format([480, 640, 3]).unwrap(), (Layout::Hwc, PixelFormat::Bgr, 640, 480));
        assert_eq!(Image::guess_format([3, 480, 640]).unwrap(), (Layout::Chw, PixelFormat::Rgb, 640, 480));
        assert_eq!(Image::guess_format([480, 640, 1]).unwrap(), (Layout::Hwc, PixelFormat::Grey, 640, 480));
        assert!(Image::guess_format([2, 640, 480]).is_err());
    }
}
