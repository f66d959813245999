//! A small network without dense layers that learns from patches and looks at whole pictures of 720 or 1080 lines.
//!
//! After M. Tzelepi and A. Tefas, "Class-Specific Discriminant Regularization in Real-Time Deep CNN Models for Binary
//! Classification Problems", Neural Processing Letters 2020. It tells a patch from the background; over a whole picture, it does
//! so at every eighth pixel at the cost of one pass.

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
use opendr_perception_common::category_scores::category_of_two;
use opendr_perception_common::picture_network::PictureNetwork;
use opendr_vision::Preprocess;

#[cfg(feature = "training")]
pub use fit::HighResolutionPatchesFitParams;

opendr_engine::choices! {
    /// The network, by the pictures that it is meant for.
    pub enum PatchArchitecture {
        /// Patches of 64 pixels.
        Vgg720p = "VGG_720p",
        /// Patches of 96 pixels, and half as many channels.
        Vgg1080p = "VGG_1080p",
    }
}

impl PatchArchitecture {
    /// Side of a patch, pixels.
    pub fn side(self) -> usize {
        match self {
            Self::Vgg720p => 64,
            Self::Vgg1080p => 96,
        }
    }
}

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct HighResolutionPatchesParams {
    /// The network that is trained; a loaded model is of the one it was trained as.
    pub architecture: PatchArchitecture,
}

/// What is told of a picture.
#[derive(Default, Targets)]
pub struct HighResolutionPatchesTargets {
    /// Probabilities `[rows, columns]`: that of row `y` and column `x` is of the square patch whose left-top corner is
    /// (8x, 8y).
    pub map: Heatmap,
    /// Class 1 where one of the patches is rather that than class 0, by the probability of the best; of a picture of a patch's
    /// size its class.
    pub category: Category,
}

/// A loaded network.
pub struct HighResolutionPatches {
    params: HighResolutionPatchesParams,
    classes: Classes,
    network: PictureNetwork,
}

/// The network's output: logits `[1, 2, rows, columns]`, of what is not and what is looked for.
const LOGITS: &str = "logits";
/// Levels 0..=255 become -1..=1.
const LEVEL: f32 = 127.5;

fn preprocess(side: usize) -> Preprocess {
    Preprocess::new(side, side).normalise([LEVEL; 3], [LEVEL; 3])
}

impl Learner for HighResolutionPatches {
    const SPEC: Spec = Spec::new("binary_high_resolution", Task::BinaryHighResolution)
        .class("BinaryHighResolutionLearner")
        .about(
            "Tells where a picture of full high definition shows what it has learned to look for; it trains.",
        );
    type Params = HighResolutionPatchesParams;
    type Input<'a> = &'a Image;
    type Target = HighResolutionPatchesTargets;
    type State = ();

    fn load(model: &Model, params: HighResolutionPatchesParams, device: Device) -> Result<Self> {
        let network = PictureNetwork::open(model, device, |_| preprocess(params.architecture.side()))?;
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
        // What is smaller than a patch is stretched to one.
        let side = self.params.architecture.side();
        let size = [image.width(), image.height()].map(|length| length.max(side));
        self.network.run_sized(image.view(), size, |outputs, _| {
            let [logits] = outputs else {
                return Err(Error::format(format!("{} outputs instead of one map", outputs.len())));
            };
            let &[1, 2, rows, columns] = logits.shape() else {
                return Err(Error::format(format!(
                    "a map of {:?} instead of [1, 2, rows, columns]",
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
            category_of_two(category, best > 0.5, best, &self.classes);
            Ok(())
        })
    }
}
