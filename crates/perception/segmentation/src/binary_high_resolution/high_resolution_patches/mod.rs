//! A small fully convolutional network that trains on patches and runs on whole images of 720 or 1080 lines.
//!
//! After M. Tzelepi and A. Tefas, "Class-Specific Discriminant Regularization in Real-Time Deep CNN Models for Binary
//! Classification Problems", Neural Processing Letters 2020. The network distinguishes a patch with an object from the
//! background; on a whole image, it does so at every eighth pixel in one pass.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec, Targets};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes, Heatmap};
use opendr_engine::{Device, Error, Result, Task};
use opendr_perception_common::category_scores::binary_category;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::Preprocess;

#[cfg(feature = "training")]
pub use fit::HighResolutionPatchesFitParams;

opendr_engine::choices! {
    /// Network architecture, by the resolution of the images.
    pub enum PatchArchitecture {
        /// Patches of 64 pixels.
        Vgg720p = "VGG_720p",
        /// Patches of 96 pixels, and half as many channels.
        Vgg1080p = "VGG_1080p",
    }
}

impl PatchArchitecture {
    /// Returns the side of a patch in pixels.
    pub fn side(self) -> usize {
        match self {
            Self::Vgg720p => 64,
            Self::Vgg1080p => 96,
        }
    }
}

/// Parameters of [`HighResolutionPatches`].
#[derive(Debug, Clone, Params)]
pub struct HighResolutionPatchesParams {
    /// Architecture of the network that is trained; a loaded model has its own.
    pub architecture: PatchArchitecture,
}

/// Prediction for an image.
#[derive(Default, Targets)]
pub struct HighResolutionPatchesTargets {
    /// Probabilities `[rows, columns]`: that of row `y` and column `x` is of the square patch whose top left corner is (8x,
    /// 8y).
    pub map: Heatmap,
    /// Class 1 where at least one patch has a probability above 0.5, with that of the best patch, else class 0. For an image of
    /// the size of a patch, the class of the patch.
    pub category: Category,
}

/// A loaded network.
pub struct HighResolutionPatches {
    params: HighResolutionPatchesParams,
    classes: Classes,
    network: ImageNetwork,
}

/// Output of the network: logits `[1, 2, rows, columns]` of background and object.
const LOGITS: &str = "logits";
/// Divisor that maps levels 0..=255 to -1..=1.
const LEVEL: f32 = 127.5;

fn preprocess(side: usize) -> Preprocess {
    Preprocess::new(side, side).normalise([LEVEL; 3], [LEVEL; 3])
}

impl Learner for HighResolutionPatches {
    const SPEC: Spec = Spec::new("binary_high_resolution", Task::BinaryHighResolution)
        .class("BinaryHighResolutionLearner")
        .about(
            "A small convolutional network detects where a high-resolution image shows the trained class; trainable.",
        );
    type Params = HighResolutionPatchesParams;
    type Input<'a> = &'a Image;
    type Target = HighResolutionPatchesTargets;
    type State = ();

    fn load(model: &Model, params: HighResolutionPatchesParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |_| preprocess(params.architecture.side()))?;
        network.output(LOGITS)?;
        Ok(Self { params, classes: model.classes().clone(), network })
    }

    fn params(&self) -> &HighResolutionPatchesParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut HighResolutionPatchesParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        _: &mut (),
        image: &Image,
        HighResolutionPatchesTargets { map, category }: &mut HighResolutionPatchesTargets,
    ) -> Result<()> {
        // Images smaller than a patch are stretched to one.
        let side = self.params.architecture.side();
        let size = [image.width(), image.height()].map(|length| length.max(side));
        self.network.run_sized(image.view(), size, |outputs, _| {
            let [logits] = outputs else {
                return Err(Error::format(format!(
                    "the network has {} outputs instead of one map",
                    outputs.len()
                )));
            };
            let &[1, 2, rows, columns] = logits.shape() else {
                return Err(Error::format(format!(
                    "the network returns a map of shape {:?} instead of [1, 2, rows, columns]",
                    logits.shape()
                )));
            };
            let values = logits.values::<f32>()?;
            let (nothing, something) = values.split_at(values.len() / 2);
            let scores = map.scores_mut(&[rows, columns]);
            for (score, (nothing, something)) in scores.iter_mut().zip(nothing.iter().zip(something)) {
                *score = 1.0 / (1.0 + (nothing - something).exp());
            }
            let best = scores.iter().copied().fold(0.0, f32::max);
            map.classes.clone_from(&self.classes);
            binary_category(category, best > 0.5, best, &self.classes);
            Ok(())
        })
    }
}
