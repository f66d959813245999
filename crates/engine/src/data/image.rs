//! Pictures: what users see is CHW RGB `u8`; what is stored may be any order, so that a camera frame is never
//! transposed for nothing.

use std::fmt;
use std::sync::Arc;

use crate::data::image_view::{ImageView, Samples};
use crate::numpy_text::{Number, array_str};
use crate::{Error, Header, Result};

/// The channels of a pixel, in their order in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PixelFormat {
    /// One channel: luminance, depth or infrared.
    Grey,
    /// Red, green, blue.
    Rgb,
    /// Blue, green, red (OpenCV's order).
    Bgr,
    /// Red, green, blue, opacity.
    Rgba,
    /// Blue, green, red, opacity.
    Bgra,
}

impl PixelFormat {
    /// How many channels a pixel has.
    pub const fn channels(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb | Self::Bgr => 3,
            Self::Rgba | Self::Bgra => 4,
        }
    }

    /// Where red, green and blue lie among the channels.
    pub const fn rgb_offsets(self) -> [usize; 3] {
        match self {
            Self::Grey => [0, 0, 0],
            Self::Rgb | Self::Rgba => [0, 1, 2],
            Self::Bgr | Self::Bgra => [2, 1, 0],
        }
    }
}

/// Which index runs fastest in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Layout {
    /// `[height, width, channels]`: pixels lie together (cameras, decoders, OpenCV).
    Hwc,
    /// `[channels, height, width]`: planes lie together (networks, OpenDR's `numpy()`).
    Chw,
}

/// The samples of a picture. Shared: cloning an [`Image`] copies no pixels.
#[derive(Debug, Clone, PartialEq)]
pub enum Pixels {
    /// 8 bits a sample, 0..=255.
    U8(Arc<Vec<u8>>),
    /// 16 bits a sample: depth in millimetres, thermal counts.
    U16(Arc<Vec<u16>>),
    /// Floats: depth in metres, or colours in the range their source gave.
    F32(Arc<Vec<f32>>),
}

impl Pixels {
    /// How many samples there are.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(data) => data.len(),
            Self::U16(data) => data.len(),
            Self::F32(data) => data.len(),
        }
    }

    /// Whether there is no sample.
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

/// A picture with its time stamp and frame id. Cloning is cheap: the pixels are shared.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// When and where it was taken.
    pub header: Header,
    pixels: Pixels,
    width: usize,
    height: usize,
    format: PixelFormat,
    layout: Layout,
}

impl Image {
    /// A picture of `width` x `height` pixels over samples stored as `format` and `layout` say.
    ///
    /// # Errors
    /// `InvalidInput` when the number of samples is not `width * height * channels`, or a side is 0.
    pub fn new(
        pixels: impl Into<Pixels>,
        width: usize,
        height: usize,
        format: PixelFormat,
        layout: Layout,
    ) -> Result<Self> {
        let pixels = pixels.into();
        let wanted = width.checked_mul(height).and_then(|area| area.checked_mul(format.channels()));
        if wanted != Some(pixels.len()) || pixels.is_empty() {
            return Err(Error::invalid_input(format!(
                "a {width}x{height} {format:?} picture needs {} samples, not {}; give at least one pixel",
                wanted.map_or_else(|| "too many".to_owned(), |count| count.to_string()),
                pixels.len(),
            )));
        }
        Ok(Self { header: Header::default(), pixels, width, height, format, layout })
    }

    /// A `u8` picture from `[height, width, 3]` RGB bytes.
    ///
    /// # Errors
    /// `InvalidInput` when there are not `width * height * 3` bytes.
    pub fn from_rgb8(data: Vec<u8>, width: usize, height: usize) -> Result<Self> {
        Self::new(data, width, height, PixelFormat::Rgb, Layout::Hwc)
    }

    /// The same picture with another header.
    #[must_use]
    pub fn with_header(mut self, header: Header) -> Self {
        self.header = header;
        self
    }

    /// Pixels a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Order of the channels in memory.
    pub fn format(&self) -> PixelFormat {
        self.format
    }

    /// Order of the axes in memory.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.format.channels()
    }

    /// The samples as they are stored.
    pub fn pixels(&self) -> &Pixels {
        &self.pixels
    }

    /// The `u8` samples, to change in place; copied first when another [`Image`] shares them. `None` when the
    /// samples are of another type.
    pub fn bytes_mut(&mut self) -> Option<&mut [u8]> {
        match &mut self.pixels {
            Pixels::U8(data) => Some(Arc::make_mut(data).as_mut_slice()),
            _ => None,
        }
    }

    /// Gives the samples back, for a source that fills the same memory again.
    pub fn into_pixels(self) -> Pixels {
        self.pixels
    }

    /// A strided view of the whole picture: what kernels read.
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

    /// A copy of the `u8` samples as `[height, width, channels]` in `format` (OpenCV's picture is `Bgr`).
    ///
    /// Grey becomes three equal channels, opacity is dropped or set to 255, `u16` and `f32` samples are scaled
    /// as [`ImageView::sample_u8`] says.
    pub fn hwc_u8(&self, format: PixelFormat) -> Vec<u8> {
        self.view().hwc_u8(format)
    }

    /// A copy of the `u8` samples as `[channels, height, width]`, RGB (grey pictures keep their one channel):
    /// OpenDR's `Image.numpy()`.
    pub fn chw_u8(&self) -> Vec<u8> {
        self.view().chw_u8()
    }

    /// OpenDR's guess of an array's meaning from its shape alone: last axis 3 means HWC **BGR** (OpenCV), another
    /// last axis smaller than both others means HWC RGB, everything else CHW RGB.
    ///
    /// Returns layout, format, width and height of a `[a, b, c]` array.
    ///
    /// # Errors
    /// `InvalidInput` when the number of channels is not 1, 3 or 4.
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
                    "an array of shape {shape:?} is no picture: 1, 3 or 4 channels are wanted, first or last"
                )));
            }
        };
        Ok((layout, format, width, height))
    }
}

impl crate::data::Data for Image {}

/// OpenDR's text: `[channels, height, width]`, RGB, as NumPy prints it; `{:#}` gives size, channels and samples.
impl fmt::Display for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height, format) = (self.width, self.height, self.format);
        if f.alternate() {
            let samples = match self.pixels {
                Pixels::U8(_) => "u8",
                Pixels::U16(_) => "u16",
                Pixels::F32(_) => "f32",
            };
            return writeln!(f, "{width}x{height} picture, {format:?}, {samples}");
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
    fn stored_order_does_not_show() {
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
    fn change_in_place_leaves_copies_alone() {
        let mut image = Image::from_rgb8(vec![1, 2, 3], 1, 1).unwrap();
        let before = image.clone();
        image.bytes_mut().unwrap()[0] = 9;
        assert_eq!((image.chw_u8(), before.chw_u8()), (vec![9, 2, 3], vec![1, 2, 3]));
        let mut depth = Image::new(vec![1.0f32], 1, 1, PixelFormat::Grey, Layout::Hwc).unwrap();
        assert!(depth.bytes_mut().is_none());
    }

    #[test]
    fn wrong_number_of_samples_is_refused() {
        assert!(Image::from_rgb8(vec![0; 5], 2, 1).is_err());
        assert!(Image::from_rgb8(Vec::new(), 0, 0).is_err());
        assert!(Image::from_rgb8(vec![0; 3], usize::MAX, usize::MAX).is_err());
    }

    #[test]
    fn guess_is_opendrs() {
        assert_eq!(Image::guess_format([480, 640, 3]).unwrap(), (Layout::Hwc, PixelFormat::Bgr, 640, 480));
        assert_eq!(Image::guess_format([3, 480, 640]).unwrap(), (Layout::Chw, PixelFormat::Rgb, 640, 480));
        assert_eq!(Image::guess_format([480, 640, 1]).unwrap(), (Layout::Hwc, PixelFormat::Grey, 640, 480));
        assert!(Image::guess_format([2, 640, 480]).is_err());
    }
}
