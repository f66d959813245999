//! Access to the `u8` pixels of a sample.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result};

use crate::augment::picture::transform::picture_mut;

/// `u8` pixels, `HWC`, grey or RGB.
pub(super) struct Bytes<'a> {
    pub(super) samples: &'a mut [u8],
    pub(super) width: usize,
    /// Number of channels, 1 or 3.
    pub(super) channels: usize,
}

/// Calls `change` with each image of `u8` samples, as grey or RGB. Other images hold measurements (depth,
/// temperature) and are not changed.
pub(super) fn for_each_u8_image(sample: &mut Sample, mut change: impl FnMut(Bytes<'_>)) -> Result<()> {
    let mut changed = false;
    for image in sample.data.iter_mut().filter_map(picture_mut) {
        if matches!(image.pixels(), Pixels::U8(_)) {
            make_interleaved(image)?;
            let (width, channels) = (image.width(), image.channels());
            change(Bytes { samples: image.bytes_mut().unwrap_or_default(), width, channels });
            changed = true;
        }
    }
    match changed {
        true => Ok(()),
        false => Err(Error::invalid_input(
            "the sample has no image of u8 samples; remove the augmentation, or convert the images first",
        )),
    }
}

/// Converts an image to grey or RGB `u8`, `HWC`.
pub(super) fn make_interleaved(image: &mut Image) -> Result<()> {
    let format = match image.format() {
        PixelFormat::Grey => PixelFormat::Grey,
        _ => PixelFormat::Rgb,
    };
    if image.format() != format || image.layout() != Layout::Hwc || !matches!(image.pixels(), Pixels::U8(_)) {
        let (width, height, header) = (image.width(), image.height(), image.header.clone());
        *image = Image::new(image.hwc_u8(format), width, height, format, Layout::Hwc)?.with_header(header);
    }
    Ok(())
}
