//! Augmentation: samples with one failed sensor.

use opendr_datasets::augment::{Augment, OtherSamples};
use opendr_engine::data::{Image, Pixels};
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Random, Result, Value};

/// Replaces one of the two images of a sample, each with probability 0.5, by a black one.
#[derive(Debug, Clone, Copy)]
pub(super) struct DropSensor;

impl DropSensor {
    pub const NAME: &'static str = "drop_sensor";
}

impl Augment for DropSensor {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let failed = random.below(2);
        match sample.data.get_mut(failed) {
            Some(Value::Image(image)) => *image = blank(image)?,
            _ => {
                return Err(Error::invalid_input(
                    "the sample does not have two images; give one of each sensor",
                ));
            }
        }
        Ok(())
    }
}

/// Returns a black image of the size of `image`.
///
/// # Errors
/// As [`Image::from_rgb8`].
pub(super) fn blank(image: &Image) -> Result<Image> {
    let (width, height) = (image.width(), image.height());
    Image::from_rgb8(vec![0; width * height * 3], width, height)
}

/// Returns whether an image is completely black.
pub(super) fn is_blank(image: &Image) -> bool {
    match image.pixels() {
        Pixels::U8(levels) => levels.iter().all(|level| *level == 0),
        _ => false,
    }
}
