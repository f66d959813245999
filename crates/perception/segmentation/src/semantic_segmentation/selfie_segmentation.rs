//! MediaPipe's selfie segmentation: separates a person near the camera from the background.
//!
//! Google, model card "MediaPipe Selfie Segmentation", 2021, Apache-2.0: a MobileNetV3 in the shape of a U-Net that predicts a
//! probability for each pixel of the image, which is stretched to the network's size.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::manifest_preprocess::preprocess_from_manifest;

/// Parameters of [`SelfieSegmentation`].
#[derive(Debug, Clone, Params)]
pub struct SelfieSegmentationParams {
    /// Minimum probability of a pixel of the person.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Whether the map holds probabilities, for blending, instead of classes.
    #[param(default = false, live)]
    pub probabilities: bool,
}

/// A loaded selfie segmentation.
pub struct SelfieSegmentation {
    params: SelfieSegmentationParams,
    classes: Classes,
    network: ImageNetwork,
    /// Size of the network's map.
    width: usize,
    height: usize,
    rows: Pool<Vec<f32>>,
}

/// Default divisor, which maps levels 0..=255 to 0..1.
const DEFAULT_LEVEL: f32 = 255.0;

impl Learner for SelfieSegmentation {
    const SPEC: Spec = Spec::new("selfie_segmentation", Task::SemanticSegmentation)
        .class("SelfieSegmentationLearner")
        .about("Separates a person near the camera from the background.");
    type Params = SelfieSegmentationParams;
    type Input<'a> = &'a Image;
    type Target = Heatmap;
    type State = ();

    fn load(model: &Model, params: SelfieSegmentationParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open_file(model, "model.onnx", device, |input| {
            preprocess_from_manifest(model, input, DEFAULT_LEVEL)
        })?;
        let [map] = network.outputs() else {
            let count = network.outputs().len();
            return Err(Error::format(format!("the network has {count} outputs instead of one map")));
        };
        let (&[Some(1), Some(1), Some(height), Some(width)] | &[Some(1), Some(height), Some(width), Some(1)]) =
            &map.dims[..]
        else {
            return Err(Error::format(format!(
                "the output {map} is not a map of probabilities [1, 1, height, width]"
            )));
        };
        if width * height == 0 {
            return Err(Error::format(format!("the output {map} has no pixels")));
        }
        let classes = model.classes().clone();
        Ok(Self { params, classes, network, width, height, rows: Pool::default() })
    }

    fn params(&self) -> &SelfieSegmentationParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SelfieSegmentationParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, map: &mut Heatmap) -> Result<()> {
        let shape @ [_, width] = [image.height(), image.width()];
        map.classes.clone_from(&self.classes);
        let row = &mut *self.rows.take();
        row.resize(self.width, 0.0);
        let SelfieSegmentationParams { threshold, probabilities } = self.params;
        self.network.run(image, |outputs, _| {
            let found = outputs.first().map_or(Ok(&[][..]), TensorView::values::<f32>)?;
            if found.len() != self.width * self.height {
                let (count, wanted) = (found.len(), self.width * self.height);
                return Err(Error::format(format!(
                    "the network returns {count} probabilities instead of {wanted}"
                )));
            }
            if probabilities {
                let out = map.scores_mut(&shape).chunks_exact_mut(width);
                self.each_row(found, row, shape, out, |probability| probability);
            } else {
                let out = map.labels_mut(&shape).chunks_exact_mut(width);
                self.each_row(found, row, shape, out, |probability| u32::from(probability >= threshold));
            }
            Ok(())
        })
    }
}

impl SelfieSegmentation {
    /// Writes the map at the image's size, `[height, width]`, by bilinear interpolation with half-pixel centres. `between` is
    /// the buffer of a row.
    fn each_row<'o, T: 'o>(
        &self,
        found: &[f32],
        between: &mut [f32],
        [height, width]: [usize; 2],
        out: impl Iterator<Item = &'o mut [T]>,
        written: impl Fn(f32) -> T,
    ) {
        let row_of = |y: usize| &found[y * self.width..][..self.width];
        for (y, out) in out.enumerate() {
            let (upper, lower, down) = neighbours(y, height, self.height);
            for ((between, upper), lower) in between.iter_mut().zip(row_of(upper)).zip(row_of(lower)) {
                *between = upper + down * (lower - upper);
            }
            for (x, out) in out.iter_mut().enumerate() {
                let (left, right, across) = neighbours(x, width, self.width);
                *out = written(between[left] + across * (between[right] - between[left]));
            }
        }
    }
}

/// Returns the two of `there` pixels around the centre of pixel `at` of `here` pixels, and the share of the distance from the
/// first.
fn neighbours(at: usize, here: usize, there: usize) -> (usize, usize, f32) {
    let place = ((at as f32 + 0.5) * there as f32 / here as f32 - 0.5).clamp(0.0, (there - 1) as f32);
    let before = place as usize;
    (before, (before + 1).min(there - 1), place - before as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centres_lie_between_centres() {
        assert_eq!(
            (0..4).map(|at| neighbours(at, 4, 2)).collect::<Vec<_>>(),
            [(0, 1, 0.0), (0, 1, 0.25), (0, 1, 0.75), (1, 1, 0.0)]
        );
        for (here, there) in [(1, 256), (256, 1), (1920, 256), (7, 7)] {
            assert!((0..here).all(|at| neighbours(at, here, there).1 < there));
            assert!((0..here).all(|at| (0.0..1.0).contains(&neighbours(at, here, there).2)));
        }
    }
}
