//! Decoding of image files into [`Image`].

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;
use std::sync::OnceLock;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::{Error, Result, ResultExt};

use crate::codec::orientation::upright;
use crate::codec::size_limit::{LIMIT_VARIABLE, check_size};
use crate::codec::{finding, jpeg};

/// Bytes from which the format is detected.
const HEAD: u64 = 64;
/// Default limit of samples per image: 89 megapixels of RGB.
const MAX_SAMPLES: u64 = 1 << 28;
/// Decodes image files within a size limit.
///
/// The result is turned upright as its EXIF orientation states: `u8`, `HWC`, grey, RGB or RGBA. Palettes are
/// resolved, 16-bit samples keep their high byte, grey with alpha becomes RGBA, CMYK and YCCK become RGB. Of an
/// animation the first frame is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decoder {
    /// Maximum number of samples (width x height x channels), checked against the header before memory is allocated.
    /// Files of more than twice as many bytes are rejected unread.
    pub max_samples: u64,
}

impl Default for Decoder {
    /// Limits the samples to the value of `OPENDR_MAX_SAMPLES`, by default 2^28: 89 megapixels of RGB.
    fn default() -> Self {
        static LIMIT: OnceLock<u64> = OnceLock::new();
        let set = || std::env::var(LIMIT_VARIABLE).ok()?.trim().parse().ok();
        Self { max_samples: *LIMIT.get_or_init(|| set().unwrap_or(MAX_SAMPLES)) }
    }
}

/// Reads the image at `path` with the default [`Decoder`].
///
/// # Errors
/// See [`Decoder::open`].
pub fn open(path: impl AsRef<Path>) -> Result<Image> {
    Decoder::default().open(path)
}

/// Decodes the image in `bytes` with the default [`Decoder`].
///
/// # Errors
/// See [`Decoder::decode`].
pub fn decode(bytes: &[u8]) -> Result<Image> {
    Decoder::default().decode(bytes)
}

impl Decoder {
    /// Reads the image at `path`. The content determines the format, not the name.
    ///
    /// # Errors
    /// `NotFound` or `Io` when the file cannot be read, and the errors of [`Decoder::decode`]; all state the path.
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Image> {
        let path = path.as_ref();
        let picture = self.read(path).and_then(|bytes| self.decode(&bytes));
        picture.context(|| format!("opening {}", path.display()))
    }

    /// Decodes the image in `bytes`.
    ///
    /// # Errors
    /// `InvalidInput` when the bytes are not an image, are damaged or truncated (no partial image is returned), or
    /// exceed [`Decoder::max_samples`]; `Unsupported` for a known format that cannot be decoded.
    pub fn decode(&self, bytes: &[u8]) -> Result<Image> {
        let (stored, orientation) = match finding::format_of(bytes)? {
            ImageFormat::Jpeg => jpeg::decode(bytes, self.max_samples)?,
            format => self.decode_other(bytes, format)?,
        };
        upright(stored, orientation)
    }

    pub(super) fn read(&self, path: &Path) -> Result<Vec<u8>> {
        let limit = self.max_bytes();
        let mut file = File::open(path)?;
        let metadata = file.metadata()?;
        if metadata.is_dir() {
            return Err(Error::invalid_input(
                "the path is a folder, not an image file; pass the path of a file",
            ));
        }
        let mut bytes = Vec::new();
        file.by_ref().take(HEAD).read_to_end(&mut bytes)?;
        // The format is checked first, so that a large file that is not an image is not read.
        finding::format_of(&bytes)?;
        bytes.reserve(metadata.len().min(limit) as usize);
        file.take(limit).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > limit {
            return Err(Error::invalid_input(format!(
                "the file exceeds the limit of {limit} bytes; if it is an image that can be trusted, set {LIMIT_VARIABLE} above {}",
                self.max_samples
            )));
        }
        Ok(bytes)
    }

    /// Returns the limit of bytes: twice the samples, for 16 bits each, and space for metadata.
    fn max_bytes(&self) -> u64 {
        self.max_samples.saturating_mul(2).saturating_add(1 << 20)
    }

    fn decode_other(&self, bytes: &[u8], format: ImageFormat) -> Result<(Image, Orientation)> {
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(self.max_bytes());
        reader.limits(limits);
        let damaged = |error| finding::damaged(format, error);
        let mut decoder = reader.into_decoder().map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        check_size(width, height, decoder.color_type().channel_count(), self.max_samples)?;
        let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
        let picture = DynamicImage::from_decoder(decoder).map_err(damaged)?;
        Ok((image_from_dynamic(picture)?, orientation))
    }
}

fn image_from_dynamic(picture: DynamicImage) -> Result<Image> {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let high_bytes = |samples: Vec<u16>| samples.into_iter().map(|sample| (sample >> 8) as u8).collect();
    let (format, samples) = match picture {
        DynamicImage::ImageLuma8(grey) => (PixelFormat::Grey, grey.into_raw()),
        DynamicImage::ImageRgb8(rgb) => (PixelFormat::Rgb, rgb.into_raw()),
        DynamicImage::ImageRgba8(rgba) => (PixelFormat::Rgba, rgba.into_raw()),
        DynamicImage::ImageLuma16(grey) => (PixelFormat::Grey, high_bytes(grey.into_raw())),
        DynamicImage::ImageRgb16(rgb) => (PixelFormat::Rgb, high_bytes(rgb.into_raw())),
        DynamicImage::ImageRgba16(rgba) => (PixelFormat::Rgba, high_bytes(rgba.into_raw())),
        DynamicImage::ImageLumaA16(grey) => {
            let pairs = grey.into_raw();
            let rgba = pairs.chunks_exact(2).flat_map(|pair| [pair[0], pair[0], pair[0], pair[1]]);
            (PixelFormat::Rgba, rgba.map(|sample| (sample >> 8) as u8).collect())
        }
        other => (PixelFormat::Rgba, other.into_rgba8().into_raw()),
    };
    Image::new(samples, width, height, format, Layout::Hwc)
}
