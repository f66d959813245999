//! Greyscale.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::pixels::for_each_u8_image;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Replaces colours by their luminance (ITU-R BT.601); the image keeps its three channels.
#[derive(Debug, Clone, Params)]
pub struct Grey {}

impl Augmentation for Grey {
    const NAME: &'static str = "grey";
    const ABOUT: &'static str = "converts to greyscale";
}

impl Augment for Grey {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        for_each_u8_image(sample, |picture| {
            if picture.channels == 3 {
                for pixel in picture.samples.as_chunks_mut::<3>().0 {
                    let [red, green, blue] = pixel.map(u32::from);
                    *pixel = [((red * 19595 + green * 38470 + blue * 7471 + 0x8000) >> 16) as u8; 3];
                }
            }
        })
    }
}
