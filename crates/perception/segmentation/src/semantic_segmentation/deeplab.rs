//! DeepLab v3 on MobileNets: semantic segmentation.
//!
//! Chen, Papandreou, Schroff and Adam, Rethinking Atrous Convolution for Semantic Image Segmentation, 2017 (arXiv 1706.05587).
//! The image is stretched to the network's square input; the network returns a class index for each of its pixels, and the map
//! is resized by nearest neighbour.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap};
use opendr_engine::{Device, Error, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::manifest_preprocess::preprocess_from_manifest;

use super::nearest;

/// Parameters of [`Deeplab`].
#[derive(Debug, Clone, Params)]
pub struct DeeplabParams {
    /// Whether the map has the size of the image; else it has the network's.
    #[param(default = true, live)]
    pub full_size: bool,
}

/// A loaded DeepLab.
pub struct Deeplab {
    params: DeeplabParams,
    classes: Classes,
    network: ImageNetwork,
    /// Size of the network's map.
    width: usize,
    height: usize,
}

/// Default divisor, which maps levels 0..=255 to -1..1.
const DEFAULT_LEVEL: f32 = 127.5;

impl Learner for Deeplab {
    const SPEC: Spec = Spec::new("deeplab", Task::SemanticSegmentation)
        .class("DeeplabLearner")
        .about("DeepLab v3 predicts the class of every pixel, in INT8.");
    type Params = DeeplabParams;
    type Input<'a> = &'a Image;
    type Target = Heatmap;
    type State = ();

    fn load(model: &Model, params: DeeplabParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open_file(model, "model.onnx", device, |input| {
            preprocess_from_manifest(model, input, DEFAULT_LEVEL)
        })?;
        let [map] = network.outputs() else {
            let count = network.outputs().len();
            return Err(Error::format(format!(
                "the network has {count} outputs instead of one map of classes"
            )));
        };
        let &[Some(1), Some(height), Some(width)] = &map.dims[..] else {
            return Err(Error::format(format!(
                "the output {map} is not a map of classes [1, height, width]"
            )));
        };
        Ok(Self { params, classes: model.classes().clone(), network, width, height })
    }

    fn params(&self) -> &DeeplabParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut DeeplabParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, map: &mut Heatmap) -> Result<()> {
        let (width, height) = match self.params.full_size {
            true => (image.width(), image.height()),
            false => (self.width, self.height),
        };
        map.classes.clone_from(&self.classes);
        let labels = map.labels_mut(&[height, width]);
        self.network.run(image, |outputs, _| {
            let classes = outputs.first().map_or(Ok(&[][..]), TensorView::values::<i64>)?;
            if classes.len() != self.width * self.height || width == 0 || height == 0 {
                let (count, wanted) = (classes.len(), self.width * self.height);
                return Err(Error::format(format!(
                    "the network returns {count} classes instead of {wanted}"
                )));
            }
            for (y, row) in labels.chunks_exact_mut(width).enumerate() {
                let from = nearest(y, height, self.height) * self.width;
                for (x, label) in row.iter_mut().enumerate() {
                    let class = classes[from + nearest(x, width, self.width)];
                    *label = u32::try_from(class).map_err(|_| {
                        Error::format(format!("the network returns the invalid class {class}"))
                    })?;
                }
            }
            Ok(())
        })
    }
}
