//! Batches, loss and container.

use burn::tensor::Device;
use opendr_datasets::loader::Collate;
use opendr_engine::Random;
use opendr_engine::data::Image;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::BoundingBoxList;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::dynamic_sides::with_dynamic_sides;
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::regions::Region;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};
use opendr_vision::Preprocess;

use super::network::PatchNetwork;
use super::{HighResolutionPatches, HighResolutionPatchesParams, LOGITS, preprocess};

/// Training objective: cross-entropy over patches.
pub(super) struct Patches<'a> {
    pub params: &'a HighResolutionPatchesParams,
    /// Maximum number of patches of each class per image.
    pub most: usize,
}

impl Objective for Patches<'_> {
    type Network = PatchNetwork;
    type Collate = PatchBatches;

    fn collate(&self) -> Result<PatchBatches> {
        let side = self.params.architecture.side();
        Ok(PatchBatches { preprocess: preprocess(side), side, most: self.most })
    }

    fn loss(&self, network: &PatchNetwork, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let side = self.params.architecture.side();
        let patches = batch.inputs([3, side * side], device);
        let [count, ..] = patches.dims();
        let logits = network.forward(patches.reshape([count, 3, side, side]));
        Ok(batch.cross_entropy(logits.reshape([count, 2]), &[], device).into())
    }

    fn container(&self, network: &PatchNetwork) -> Result<Container> {
        let side = self.params.architecture.side();
        let model = onnx(network, Input::new("image", [1, 3, side, side]), &[LOGITS], PatchNetwork::forward)?;
        let mut manifest = Manifest::new(HighResolutionPatches::SPEC.name, "");
        manifest.task = Some(HighResolutionPatches::SPEC.task);
        manifest.params = self.params.to_map();
        Ok(Container {
            manifest,
            files: vec![
                ("model.onnx".to_owned(), with_dynamic_sides(&model)?),
                (TRAINABLE.to_owned(), bytes_from_network(network)?),
            ],
        })
    }
}

/// Cuts the patches of samples into batches.
pub(super) struct PatchBatches {
    preprocess: Preprocess,
    side: usize,
    most: usize,
}

impl Collate for PatchBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, 3 * self.side * self.side)
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let Some(Value::Image(image)) = sample.data.first() else {
            return Err(Error::invalid_input(
                "the sample has no image; the samples must be patches, or images with boxes",
            ));
        };
        match &sample.target {
            Some(Value::BoundingBoxList(boxes)) => {
                for (class, patch) in self.places(image, boxes) {
                    self.push(batch, image, &patch, class)?;
                }
                Ok(())
            }
            _ => {
                let whole = Region { x: 0, y: 0, width: image.width(), height: image.height() };
                self.push(batch, image, &whole, class_of(&sample, 2)?)
            }
        }
    }
}

impl PatchBatches {
    fn push(&self, batch: &mut LabelledBatch, image: &Image, patch: &Region, class: i64) -> Result<()> {
        let view = image.view().crop(patch.x, patch.y, patch.width, patch.height);
        let view = view.ok_or_else(|| Error::internal("a patch lies outside of its image"))?;
        let mut input = vec![0.0; self.preprocess.len()];
        self.preprocess.run_into(view, &mut input)?;
        batch.push(&input, class);
        Ok(())
    }

    /// Returns patches around the boxes, and random ones that overlap no box; the image determines the random seed.
    pub(super) fn places(&self, image: &Image, boxes: &BoundingBoxList) -> Vec<(i64, Region)> {
        let size = [image.width(), image.height()];
        let [width, height] = size.map(|length| length.min(self.side));
        let at = |x: usize, y: usize| Region {
            x: x.min(size[0] - width),
            y: y.min(size[1] - height),
            width,
            height,
        };
        let regions: Vec<_> =
            boxes.boxes.iter().map(|found| Region::from_corners(found.corners(), size)).collect();
        let mut places = Vec::new();
        for region in regions.iter().filter(|region| !region.is_empty()).take(self.most) {
            let [x, y] = [region.x + region.width / 2, region.y + region.height / 2];
            places.push((1, at(x.saturating_sub(width / 2), y.saturating_sub(height / 2))));
        }
        let count = places.len().max(1);
        let mut random = Random::from_key([size[0] as u64, size[1] as u64, regions.len() as u64]);
        for _ in 0..8 * count {
            let patch = at(random.below(size[0]), random.below(size[1]));
            let is_free = regions.iter().all(|region| !region.overlaps(&patch));
            if is_free && places.iter().filter(|(class, _)| *class == 0).count() < count {
                places.push((0, patch));
            }
        }
        places
    }
}
