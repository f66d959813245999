//! BiSeNet: semantic segmentation with a spatial and a context path.
//!
//! Yu, Wang, Peng, Gao, Yu and Sang, BiSeNet: Bilateral Segmentation Network for Real-time Semantic Segmentation, ECCV 2018
//! (arXiv 1808.00897). A small variant, trained on images with masks; the context path is four residual blocks in place of a
//! pretrained ResNet.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::manifest_preprocess::preprocess_from_manifest;
#[cfg(feature = "training")]
use opendr_vision::Preprocess;

use super::nearest;

#[cfg(feature = "training")]
pub use fit::BisenetFitParams;

/// Parameters of [`Bisenet`].
#[derive(Debug, Clone, Params)]
pub struct BisenetParams {
    /// Whether the map has the size of the image; else it has the network's.
    #[param(default = true, live)]
    pub full_size: bool,
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=255)]
    pub num_classes: Option<usize>,
}

/// A loaded BiSeNet.
pub struct Bisenet {
    params: BisenetParams,
    classes: Classes,
    network: ImageNetwork,
    /// Number of classes in the network's output.
    count: usize,
    height: usize,
    width: usize,
    work: Pool<Work>,
}

/// Best class of each pixel of the network's input, and its score.
#[derive(Default)]
struct Work {
    best: Vec<u32>,
    scores: Vec<f32>,
}

/// Divisor that maps levels 0..=255 to -1..=1.
const LEVEL: f32 = 127.5;

/// Preprocessing of networks that were trained by this crate.
#[cfg(feature = "training")]
fn preprocess([height, width]: [usize; 2]) -> Preprocess {
    Preprocess::new(width, height).normalise([LEVEL; 3], [LEVEL; 3])
}

impl Learner for Bisenet {
    const SPEC: Spec = Spec::new("bisenet", Task::SemanticSegmentation)
        .class("BisenetLearner")
        .about("BiSeNet predicts the class of every pixel; trainable on your own masks.")
        .without_effect(&[
            ("context_path", "the context path is a small residual network of its own"),
            ("drop_last", "an incomplete last batch is always dropped"),
            ("pin_memory", "page-locked memory is not used"),
        ]);
    type Params = BisenetParams;
    type Input<'a> = &'a Image;
    type Target = Heatmap;
    type State = ();

    fn load(model: &Model, params: BisenetParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open_file(model, "model.onnx", device, |input| {
            preprocess_from_manifest(model, input, LEVEL)
        })?;
        let [map] = network.outputs() else {
            let count = network.outputs().len();
            return Err(Error::format(format!(
                "the network has {count} outputs instead of one map of scores"
            )));
        };
        let &[Some(1), Some(count), Some(height), Some(width)] = &map.dims[..] else {
            return Err(Error::format(format!(
                "the output {map} is not a map of scores [1, classes, height, width]"
            )));
        };
        if count * height * width == 0 {
            return Err(Error::format(format!("the output {map} has no scores")));
        }
        if let Some(wanted) = params.num_classes.filter(|wanted| *wanted != count) {
            return Err(Error::invalid_param(format!(
                "num_classes = {wanted}, but the model has {count} classes; omit num_classes or load another model"
            )));
        }
        let classes = model.classes().clone();
        Ok(Self { params, classes, network, count, height, width, work: Pool::default() })
    }

    fn params(&self) -> &BisenetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut BisenetParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, map: &mut Heatmap) -> Result<()> {
        let Work { best, scores } = &mut *self.work.take();
        let Self { count, width, height, .. } = *self;
        self.network.run(image, |outputs, _| {
            let found = outputs.first().map_or(Ok(&[][..]), TensorView::values::<f32>)?;
            if found.len() != count * width * height {
                let (numbers, wanted) = (found.len(), count * width * height);
                return Err(Error::format(format!(
                    "the network returns {numbers} scores instead of {wanted}"
                )));
            }
            best.clear();
            best.resize(width * height, 0);
            scores.clear();
            scores.resize(width * height, f32::NEG_INFINITY);
            for (class, plane) in (0..).zip(found.chunks_exact(width * height)) {
                for ((best, score), here) in best.iter_mut().zip(&mut *scores).zip(plane) {
                    if here > score {
                        (*best, *score) = (class, *here);
                    }
                }
            }
            Ok(())
        })?;
        let [rows, columns] = match self.params.full_size {
            true => [image.height(), image.width()],
            false => [height, width],
        };
        map.classes.clone_from(&self.classes);
        for (y, row) in map.labels_mut(&[rows, columns]).chunks_exact_mut(columns).enumerate() {
            let from = nearest(y, rows, height) * width;
            for (x, label) in row.iter_mut().enumerate() {
                *label = best[from + nearest(x, columns, width)];
            }
        }
        Ok(())
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
