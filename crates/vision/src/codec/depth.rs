//! Depth images: 16-bit grey PNG, in millimetres or the units of the sensor.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{DynamicImage, ImageBuffer, ImageDecoder, ImageFormat, ImageReader, Limits, Luma};
use opendr_engine::atomic_file::replace_file;
use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Error, Result, ResultExt};

use crate::codec::decode::Decoder;
use crate::codec::finding;
use crate::codec::size_limit::check_size;

impl Decoder {
    /// Reads the depth image at `path`; samples keep all 16 bits.
    ///
    /// # Errors
    /// `NotFound` or `Io` when the file cannot be read, and the errors of [`Decoder::decode_depth`]; all state the
    /// path.
    pub fn open_depth(&self, path: impl AsRef<Path>) -> Result<Image> {
        let path = path.as_ref();
        let picture = self.read(path).and_then(|bytes| self.decode_depth(&bytes));
        picture.context(|| format!("opening {}", path.display()))
    }

    /// Decodes a grey PNG of 16 bits (or 8, which are zero-extended): `u16`, `HWC`.
    ///
    /// # Errors
    /// Those of [`Decoder::decode`]; `InvalidInput` for other images.
    pub fn decode_depth(&self, bytes: &[u8]) -> Result<Image> {
        let format = finding::format_of(bytes)?;
        if format != ImageFormat::Png {
            return Err(Error::invalid_input(format!(
                "a {} file is not a depth image; pass a 16-bit grey PNG",
                finding::name(format)
            )));
        }
        let damaged = |error| finding::damaged(format, error);
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(self.max_samples.saturating_mul(2).saturating_add(1 << 20));
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        check_size(width, height, decoder.color_type().channel_count(), self.max_samples)?;
        let samples: Vec<u16> = match DynamicImage::from_decoder(decoder).map_err(damaged)? {
            DynamicImage::ImageLuma16(depth) => depth.into_raw(),
            DynamicImage::ImageLuma8(depth) => depth.into_raw().into_iter().map(u16::from).collect(),
            other => {
                let colour = other.color();
                return Err(Error::invalid_input(format!(
                    "an image of type {colour:?} is not a depth image; pass a 16-bit grey PNG"
                )));
            }
        };
        Image::new(samples, width as usize, height as usize, PixelFormat::Grey, Layout::Hwc)
    }
}

/// Encodes a grey `u16` image as a 16-bit PNG file.
///
/// # Errors
/// `InvalidInput` for another image type, or an image larger than PNG allows.
pub fn encode_depth_png(image: &Image) -> Result<Vec<u8>> {
    let Pixels::U16(samples) = image.pixels() else {
        return Err(Error::invalid_input("a depth image needs 16-bit samples; pass u16"));
    };
    let size = (u32::try_from(image.width()).ok()).zip(u32::try_from(image.height()).ok());
    let buffer = size.and_then(|(width, height)| {
        ImageBuffer::<Luma<u16>, _>::from_raw(width, height, samples.as_slice().to_vec())
    });
    let buffer =
        buffer.ok_or_else(|| Error::invalid_input("a depth image needs one channel; pass a grey image"))?;
    let mut bytes = Vec::new();
    let encoded = DynamicImage::ImageLuma16(buffer).write_with_encoder(PngEncoder::new(&mut bytes));
    encoded
        .map_err(|error| Error::invalid_input("the image is too large for a PNG file").with_source(error))?;
    Ok(bytes)
}

/// Writes a grey `u16` image to `path` as a 16-bit PNG; the write is atomic.
///
/// # Errors
/// Those of [`encode_depth_png`]; `NotFound` or `Io` when the folder is not writable; all state the path.
pub fn save_depth(image: &Image, path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    encode_depth_png(image)
        .and_then(|bytes| replace_file(path, &bytes))
        .context(|| format!("saving {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_bits_are_kept() {
        let path = std::env::temp_dir().join(format!("opendr-depth-{}.png", std::process::id()));
        let depth = Image::new(vec![0u16, 1, 258, 65535], 2, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
        save_depth(&depth, &path).unwrap();
        assert_eq!(Decoder::default().open_depth(&path).unwrap(), depth);
        let small = Decoder { max_samples: 3 }.open_depth(&path).unwrap_err();
        assert!(small.to_string().contains("2x2 pixels"), "{small}");
        let colour = Image::from_rgb8(vec![1, 2, 3], 1, 1).unwrap();
        assert!(save_depth(&colour, &path).is_err());
        crate::save(&colour, &path).unwrap();
        assert!(
            Decoder::default().open_depth(&path).unwrap_err().to_string().contains("is not a depth image")
        );
        std::fs::remove_file(path).unwrap();
    }
}
