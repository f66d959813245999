//! JPEG decoding through `zune-jpeg`: baseline and progressive; grey, YCbCr, RGB, CMYK and YCCK.

use image::metadata::Orientation;
use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::{Error, Result};
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;

use crate::codec::size_limit::check_size;

/// Decodes a JPEG of at most `max_samples` samples to grey or RGB, without applying its orientation.
pub(super) fn decode(bytes: &[u8], max_samples: u64) -> Result<(Image, Orientation)> {
    // Strict mode rejects common and harmless junk between markers. It does not detect truncation in the last row of
    // blocks, so `has_end` checks for the end marker.
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX));
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let grey = decoder.input_colorspace() == Some(ColorSpace::Luma);
    check_size(width as u32, height as u32, if grey { 1 } else { 3 }, max_samples)?;
    if !has_end(bytes) {
        return Err(Error::invalid_input(format!(
            "found a JPEG file of {width}x{height} pixels that is truncated after {} bytes; copy or download it again",
            bytes.len()
        )));
    }
    let colours = if grey { ColorSpace::Luma } else { ColorSpace::RGB };
    decoder.set_options(options.jpeg_set_out_colorspace(colours));
    let samples = decoder.decode().map_err(damaged)?;
    let format = if grey { PixelFormat::Grey } else { PixelFormat::Rgb };
    let image = Image::new(samples, width, height, format, Layout::Hwc)?;
    let orientation = decoder.exif().and_then(|exif| Orientation::from_exif_chunk(exif));
    Ok((image, orientation.unwrap_or(Orientation::NoTransforms)))
}

/// Returns width and height as stored, and the EXIF orientation.
pub(super) fn size(bytes: &[u8]) -> Result<([u32; 2], Orientation)> {
    let mut decoder = JpegDecoder::new(ZCursor::new(bytes));
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let orientation = decoder.exif().and_then(|exif| Orientation::from_exif_chunk(exif));
    Ok(([width as u32, height as u32], orientation.unwrap_or(Orientation::NoTransforms)))
}

/// Returns whether an end marker follows the start of the first scan. The segments before it are skipped, because an
/// embedded preview has markers of its own.
fn has_end(bytes: &[u8]) -> bool {
    let mut at = 2;
    while let Some(&[prefix, marker, high, low]) = bytes.get(at..at + 4) {
        at += match (prefix, marker) {
            (0xff, 0xda) => return bytes[at..].windows(2).rev().any(|pair| pair == [0xff, 0xd9]),
            (0xff, 0x02..=0xcf | 0xd8..=0xfe) => 2 + usize::from(u16::from_be_bytes([high, low])),
            _ => 1,
        };
    }
    false
}

fn damaged(error: DecodeErrors) -> Error {
    match error {
        DecodeErrors::Unsupported(scheme) => Error::unsupported(format!(
            "found a JPEG file of an unsupported kind ({scheme:?}); save it as a baseline JPEG"
        )),
        other => Error::invalid_input("found a JPEG file, damaged or truncated; copy or download it again")
            .with_source(other),
    }
}
