//! Training objective of the single-shot detector: augmentation, matched anchors, focal loss and smooth L1.

use burn::tensor::{Device, Tensor, TensorData};
use opendr_datasets::augment::{Affine, Colour, Flip, IouCrop, Mosaic, Pipeline};
use opendr_engine::Result;
use opendr_engine::learner::Learner;
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_perception_common::frozen_layers::FrozenLayers;
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::layout::Layout;
use super::loss::DetectionLoss;
use super::matching::Matching;
use super::network::Network;
use super::targets::{DetectionBatch, DetectionBatches};
use super::{SingleShotDetector, output_names};

/// Training objective of the single-shot detector.
#[derive(Debug)]
pub struct DetectionObjective {
    /// Input and anchors.
    pub layout: Layout,
    /// Classes of the network; boxes of other classes are background.
    pub classes: Classes,
    /// Thresholds of the matching of anchors and objects.
    pub matching: Matching,
    /// Score below which boxes are neither object nor background.
    pub min_score: f32,
    /// Whether images are augmented at random.
    pub augment: bool,
    /// The backbone, if it is frozen.
    pub(super) frozen: Option<FrozenLayers>,
}

impl Objective for DetectionObjective {
    type Network = Network;
    type Collate = DetectionBatches;

    fn collate(&self) -> Result<DetectionBatches> {
        Ok(DetectionBatches::new(&self.layout, self.matching, self.classes.clone(), self.min_score))
    }

    fn pipeline(&self) -> Result<Pipeline> {
        if !self.augment {
            return Ok(Pipeline::default());
        }
        let [width, height] = self.layout.image.size();
        Pipeline::default()
            .sometimes(0.3, Mosaic { width, height, ..Mosaic::default() })?
            .sometimes(0.5, IouCrop::default())?
            // The paper's expansion: objects smaller than any in the data.
            .sometimes(0.3, Affine { min_scale: 0.4, max_scale: 1.0, max_shift: 0.2, ..Affine::default() })?
            .sometimes(0.5, Flip::default())?
            .sometimes(0.8, Colour { brightness: 0.3, contrast: 0.3, saturation: 0.4, hue: 0.1 })
    }

    fn loss(&self, network: &Network, batch: &DetectionBatch, device: &Device) -> Result<Loss> {
        let [width, height] = batch.size;
        let shape = [batch.pictures, 3, height, width];
        let trunk = match &self.frozen {
            Some(backbone) => backbone.run(&batch.images, shape, device)?,
            None => network.trunk(Tensor::from_data(TensorData::new(batch.images.clone(), shape), device)),
        };
        let levels = network.forward_from(trunk);
        let DetectionLoss { scores, offsets } = DetectionLoss::new(levels, batch, self.classes.len(), device);
        // OpenDR's names of the curves.
        let parts = vec![("cross_entropy_loss", scores.clone()), ("smoothl1_loss", offsets.clone())];
        Ok(Loss { total: scores + offsets, parts })
    }

    fn container(&self, network: &Network) -> Result<Container> {
        let [width, height] = self.layout.image.size();
        let names: Vec<_> = (0..self.layout.anchors.levels.len()).flat_map(output_names).collect();
        let names: Vec<_> = names.iter().map(String::as_str).collect();
        let input = Input::new("image", [1, 3, height, width]);
        let onnx = export::onnx(network, input, &names, |network, images| {
            let levels = network.forward(images).into_iter();
            levels.map(|level| [level.scores, level.offsets]).collect::<Vec<_>>()
        })?;
        let spec = SingleShotDetector::SPEC;
        let mut manifest = Manifest::new(spec.name, "");
        manifest.task = Some(spec.task);
        manifest.classes = self.classes.clone();
        manifest.write_inputs(&self.layout)?;
        Ok(Container { manifest, files: vec![("model.onnx".to_owned(), onnx)] })
    }
}
