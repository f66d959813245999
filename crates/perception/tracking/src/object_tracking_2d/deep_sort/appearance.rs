//! How what is in a box looks, in numbers.

use opendr_engine::data::Image;
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_perception_common::picture_network::PictureNetwork;
use opendr_vision::Preprocess;

/// The input: a person upright, pixels.
const SIZE: [usize; 2] = [128, 256];
/// Of ImageNet's pictures, as torchreid normalises, levels of 0..=255.
const MEAN: [f32; 3] = [123.675, 116.28, 103.53];
const STD: [f32; 3] = [58.395, 57.12, 57.375];

/// A re-identification network: a crop of a person to numbers whose cosine tells whether two are the same.
pub(super) struct Appearance {
    network: PictureNetwork,
    length: usize,
}

impl Appearance {
    pub fn open(model: &Model, device: Device) -> Result<Self> {
        let [width, height] = SIZE;
        let network =
            PictureNetwork::open(model, device, |_| Preprocess::new(width, height).normalise(MEAN, STD))?;
        let length = match network.outputs() {
            [output] => output.dims.last().copied().flatten().filter(|length| *length > 0),
            _ => None,
        };
        let length = length.ok_or_else(|| {
            Error::format(
                "a re-identification network has one output, numbers of a fixed count; load another model",
            )
        })?;
        Ok(Self { network, length })
    }

    /// How many numbers tell of one box.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Adds the numbers of the box, scaled to length 1, to `looks`; zeros for one that is not in the picture.
    pub fn look(&self, image: &Image, corners: [f64; 4], looks: &mut Vec<f32>) -> Result<()> {
        let begin = looks.len();
        let limit = |edge: f64, side: usize| edge.round().clamp(0.0, side as f64) as usize;
        let [x0, x1] = [corners[0], corners[2]].map(|edge| limit(edge, image.width()));
        let [y0, y1] = [corners[1], corners[3]].map(|edge| limit(edge, image.height()));
        if let Some(crop) = image.view().crop(x0, y0, x1 - x0, y1 - y0).filter(|_| x1 > x0 && y1 > y0) {
            self.network.run_sized(crop, SIZE, |outputs, _| {
                let numbers =
                    outputs.first().map(|output| output.values::<f32>()).transpose()?.unwrap_or_default();
                let length = numbers.iter().map(|number| number * number).sum::<f32>().sqrt();
                if length.is_normal() {
                    looks.extend(numbers.iter().map(|number| number / length));
                }
                Ok(())
            })?;
        }
        looks.resize(begin + self.length, 0.0);
        Ok(())
    }
}
