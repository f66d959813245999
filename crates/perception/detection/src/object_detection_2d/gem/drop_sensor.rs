//! Samples of two sensors of which one failed.

use opendr_datasets::augment::{Augment, Others};
use opendr_engine::data::{Image, Pixels};
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Random, Result, Value};

/// Makes one of the two pictures of a sample, either as likely, black.
#[derive(Debug, Clone, Copy)]
pub(super) struct DropSensor;

impl DropSensor {
    pub const NAME: &'static str = "drop_sensor";
}

impl Augment for DropSensor {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &Others<'_>) -> Result<()> {
        let failed = random.below(2);
        match sample.data.get_mut(failed) {
            Some(Value::Image(image)) => *image = blank(image)?,
            _ => {
                return Err(Error::invalid_input("a sample of no two pictures; give one of each sensor"));
            }
        }
        Ok(())
    }
}

/// A black picture of the size of `image`.
///
/// # Errors
/// As [`Image::from_rgb8`].
pub(super) fn blank(image: &Image) -> Result<Image> {
    let (width, height) = (image.width(), image.height());
    Image::from_rgb8(vec![0; width * height * 3], width, height)
}

/// Whether a picture is black throughout.
pub(super) fn is_blank(image: &Image) -> bool {
    match image.pixels() {
        Pixels::U8(levels) => levels.iter().all(|level| *level == 0),
        _ => false,
    }
}
