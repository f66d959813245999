//! Resizing of images.

use opendr_engine::data::{Image, Layout, PixelFormat};
use opendr_engine::{Error, Result};

use crate::preprocess::{ChannelOrder, Preprocess};

/// Resizes `image` to `width` x `height` pixels, bilinear as in [`Preprocess`]: `u8`, `HWC`, grey or RGB.
///
/// # Errors
/// `InvalidParam` when a side is 0 or the result does not fit into memory.
pub fn resize(image: &Image, width: usize, height: usize) -> Result<Image> {
    let (order, format) = match image.format() {
        PixelFormat::Grey => (ChannelOrder::Grey, PixelFormat::Grey),
        _ => (ChannelOrder::Rgb, PixelFormat::Rgb),
    };
    let scaling = Preprocess::new(width, height).order(order).layout(Layout::Hwc);
    let mut samples = Vec::new();
    samples.try_reserve_exact(scaling.len()).map_err(|error| {
        Error::invalid_param(format!("{width}x{height} pixels do not fit into memory")).with_source(error)
    })?;
    samples.resize(scaling.len(), 0u8);
    scaling.run_into(image.view(), &mut samples)?;
    Ok(Image::new(samples, width, height, format, Layout::Hwc)?.with_header(image.header.clone()))
}
