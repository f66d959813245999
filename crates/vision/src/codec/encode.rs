//! Encoding of [`Image`] into image files.

use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;

use image::codecs::bmp::BmpEncoder;
use image::codecs::png::PngEncoder;
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageFormat};
use jpeg_encoder::{ColorType, SamplingFactor};
use opendr_engine::atomic_file::replace_file;
use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Error, Result, ResultExt};

use crate::codec::finding;

/// Encodes and writes image files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Encoder {
    /// JPEG quality, 1 (smallest file) to 100 (best).
    pub jpeg_quality: u8,
}

impl Default for Encoder {
    /// Sets JPEG quality 90.
    fn default() -> Self {
        Self { jpeg_quality: 90 }
    }
}

/// Writes `image` to `path` with the default [`Encoder`].
///
/// # Errors
/// See [`Encoder::save`].
pub fn save(image: &Image, path: impl AsRef<Path>) -> Result<()> {
    Encoder::default().save(image, path)
}

/// Encodes `image` as a PNG file; samples are converted to `u8` by [`Image::hwc_u8`].
///
/// # Errors
/// `InvalidInput` for an image larger than PNG allows.
pub fn encode_png(image: &Image) -> Result<Vec<u8>> {
    Encoder::default().encode(image, ImageFormat::Png)
}

impl Encoder {
    /// Writes `image` to `path`; the extension (`jpg`, `jpeg`, `png`, `bmp`, `webp`) determines the format.
    ///
    /// The write is atomic: a temporary file beside `path` is renamed. Grey stays grey; JPEG drops the alpha channel;
    /// WebP is lossless; samples are converted to `u8` by [`Image::hwc_u8`].
    ///
    /// # Errors
    /// `Unsupported` for another extension, `InvalidParam` for a JPEG quality outside 1..=100, `NotFound` or `Io`
    /// when the folder is not writable; all state the path.
    pub fn save(&self, image: &Image, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let written = format_of(path)
            .and_then(|format| self.encode(image, format))
            .and_then(|bytes| replace_file(path, &bytes));
        written.context(|| format!("saving {}", path.display()))
    }

    /// Encodes `image` as a JPEG file; grey stays grey, the alpha channel is dropped, samples are converted to `u8`
    /// by [`Image::hwc_u8`].
    ///
    /// # Errors
    /// `InvalidParam` for a quality outside 1..=100, `InvalidInput` for an image larger than JPEG allows.
    pub fn encode_jpeg(&self, image: &Image) -> Result<Vec<u8>> {
        self.encode(image, ImageFormat::Jpeg)
    }

    fn encode(&self, image: &Image, format: ImageFormat) -> Result<Vec<u8>> {
        if !(1..=100).contains(&self.jpeg_quality) {
            let quality = self.jpeg_quality;
            return Err(Error::invalid_param(format!(
                "jpeg_quality is {quality}; set it to a number from 1 to 100"
            )));
        }
        let pixel = match image.format() {
            PixelFormat::Grey => PixelFormat::Grey,
            PixelFormat::Rgba | PixelFormat::Bgra if format != ImageFormat::Jpeg => PixelFormat::Rgba,
            _ => PixelFormat::Rgb,
        };
        let samples = match image.pixels() {
            Pixels::U8(samples) if image.format() == pixel && image.layout() == Layout::Hwc => {
                Cow::Borrowed(samples.as_slice())
            }
            _ => Cow::Owned(image.hwc_u8(pixel)),
        };
        let size = (image.width(), image.height());
        let encoded = match format {
            ImageFormat::Jpeg => encode_jpeg(&samples, size, pixel, self.jpeg_quality),
            _ => encode_lossless(&samples, size, pixel, format),
        };
        encoded.map_err(|error| {
            Error::invalid_input(format!(
                "an image of {size:?} pixels is too large for a {} file",
                finding::name(format)
            ))
            .with_source(error)
        })
    }
}

type EncodeResult = Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>>;

fn encode_jpeg(
    samples: &[u8],
    (width, height): (usize, usize),
    pixel: PixelFormat,
    quality: u8,
) -> EncodeResult {
    let colour = if pixel == PixelFormat::Grey { ColorType::Luma } else { ColorType::Rgb };
    let mut out = Vec::new();
    let mut encoder = jpeg_encoder::Encoder::new(&mut out, quality);
    encoder.set_sampling_factor(SamplingFactor::F_2_2);
    encoder.encode(samples, width.try_into()?, height.try_into()?, colour)?;
    Ok(out)
}

fn encode_lossless(
    samples: &[u8],
    (width, height): (usize, usize),
    pixel: PixelFormat,
    format: ImageFormat,
) -> EncodeResult {
    let (width, height) = (width.try_into()?, height.try_into()?);
    let colour = match pixel {
        PixelFormat::Grey => ExtendedColorType::L8,
        PixelFormat::Rgba => ExtendedColorType::Rgba8,
        _ => ExtendedColorType::Rgb8,
    };
    let mut out = Cursor::new(Vec::new());
    match format {
        ImageFormat::Png => PngEncoder::new(&mut out).write_image(samples, width, height, colour)?,
        ImageFormat::Bmp => BmpEncoder::new(&mut out).write_image(samples, width, height, colour)?,
        _ => WebPEncoder::new_lossless(&mut out).write_image(samples, width, height, colour)?,
    }
    Ok(out.into_inner())
}

fn format_of(path: &Path) -> Result<ImageFormat> {
    match ImageFormat::from_path(path) {
        Ok(format) if format == ImageFormat::Jpeg || format.writing_enabled() => Ok(format),
        _ => Err(Error::unsupported(
            "unsupported image format; end the file name with .jpg, .jpeg, .png, .bmp or .webp",
        )),
    }
}
