//! `image_transport`'s plugin `compressedDepth`: 12 bytes, then a 16-bit PNG.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::{Error, Result};

/// Size of the head: kind of compression, then the two coefficients from inverse depth to metres.
const HEAD_BYTES: usize = 12;

/// Reads `16UC1` unchanged, and `32FC1` from inverse depth: `a / (sample - b)` metres, where 0 means unknown (NaN).
pub(super) fn read(format: &str, data: &[u8]) -> Result<Image> {
    let short = || Error::format(format!("{} bytes are too few for compressedDepth", data.len()));
    let (head, png) = data.split_at_checked(HEAD_BYTES).ok_or_else(short)?;
    if !png.starts_with(b"\x89PNG") {
        return Err(Error::unsupported(
            "compressedDepth is not a PNG but RVL; set its parameter format to png",
        ));
    }
    let image = opendr_vision::Decoder::default().decode_depth(png)?;
    if !format.starts_with("32FC1") {
        return Ok(image);
    }
    let (numbers, _) = head.as_chunks::<4>();
    let (Some(a), Some(b)) = (numbers.get(1), numbers.get(2)) else { return Err(short()) };
    let (a, b) = (f32::from_le_bytes(*a), f32::from_le_bytes(*b));
    let Pixels::U16(samples) = image.pixels() else { return Err(short()) };
    let metres: Vec<f32> = samples
        .iter()
        .map(|&sample| if sample == 0 { f32::NAN } else { a / (f32::from(sample) - b) })
        .collect();
    Image::new(metres, image.width(), image.height(), PixelFormat::Grey, Layout::Hwc)
}
