//! Appearance embeddings of boxes.

use opendr_engine::data::Image;
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::Preprocess;

/// Width and height of the input, an upright person, in pixels.
const SIZE: [usize; 2] = [128, 256];
/// ImageNet's mean and standard deviation of levels 0..=255, as in torchreid.
const MEAN: [f32; 3] = [123.675, 116.28, 103.53];
const STD: [f32; 3] = [58.395, 57.12, 57.375];

/// A re-identification network: crops of persons to embeddings, compared by their cosine.
pub(super) struct Appearance {
    network: ImageNetwork,
    length: usize,
}

impl Appearance {
    pub fn open(model: &Model, device: Device) -> Result<Self> {
        let [width, height] = SIZE;
        let network =
            ImageNetwork::open(model, device, |_| Preprocess::new(width, height).normalise(MEAN, STD))?;
        let length = match network.outputs() {
            [output] => output.dims.last().copied().flatten().filter(|length| *length > 0),
            _ => None,
        };
        let length = length.ok_or_else(|| {
            Error::format(
                "a re-identification network needs one output of a fixed length; load another model",
            )
        })?;
        Ok(Self { network, length })
    }

    /// Returns the length of an embedding.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Appends the embedding of a box, scaled to length 1, to `embeddings`; zeros for a box outside the image.
    pub fn embed(&self, image: &Image, corners: [f64; 4], embeddings: &mut Vec<f32>) -> Result<()> {
        let begin = embeddings.len();
        let limit = |edge: f64, side: usize| edge.round().clamp(0.0, side as f64) as usize;
        let [x0, x1] = [corners[0], corners[2]].map(|edge| limit(edge, image.width()));
        let [y0, y1] = [corners[1], corners[3]].map(|edge| limit(edge, image.height()));
        if let Some(crop) = image.view().crop(x0, y0, x1 - x0, y1 - y0).filter(|_| x1 > x0 && y1 > y0) {
            self.network.run_sized(crop, SIZE, |outputs, _| {
                let features =
                    outputs.first().map(|output| output.values::<f32>()).transpose()?.unwrap_or_default();
                let length = features.iter().map(|number| number * number).sum::<f32>().sqrt();
                if length.is_normal() {
                    embeddings.extend(features.iter().map(|number| number / length));
                }
                Ok(())
            })?;
        }
        embeddings.resize(begin + self.length, 0.0);
        Ok(())
    }
}
