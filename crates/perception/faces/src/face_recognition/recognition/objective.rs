//! Training objective of face recognition: aligned faces with the class of their person, ArcFace's loss.

use std::sync::Arc;

use burn::nn::loss::CrossEntropyLossConfig;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::augment::{Flip, Pipeline};
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::model::Manifest;
use opendr_engine::target::BoundingBoxList;
use opendr_engine::{Error, Result, Value};
use opendr_face_detection::face_detector::{largest_face, whole_image};
use opendr_perception_common::labelled::class_of;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};
use opendr_vision::Preprocess;

use super::network::Network;
use super::{FaceRecognition, SIDE};

/// Training objective: faces with the class of their person, ArcFace's loss (Deng et al., CVPR 2019).
pub(super) struct ArcFace {
    pub classes: usize,
    /// Margin, added to the angle between a face and its class's centre, in radians.
    pub margin: f64,
    /// Scale of the cosines.
    pub scale: f64,
    /// Detector of the faces; without it, an image is a face.
    pub finder: Option<Arc<FaceRecognition>>,
    /// Manifest of the trained container.
    pub manifest: Manifest,
    /// Files of its parts.
    pub parts: Vec<(String, Vec<u8>)>,
}

/// Collates samples into [`AlignedFaces`].
pub(super) struct Collator {
    preprocess: Preprocess,
    classes: usize,
    finder: Option<Arc<FaceRecognition>>,
}

/// Faces `[batch, 3, 112, 112]` and the class index of each.
pub(super) struct AlignedFaces {
    pixels: Vec<f32>,
    classes: Vec<i64>,
}

impl Collate for Collator {
    type Batch = AlignedFaces;

    fn start(&self, capacity: usize) -> AlignedFaces {
        let pixels = Vec::with_capacity(capacity * self.preprocess.len());
        AlignedFaces { pixels, classes: Vec::with_capacity(capacity) }
    }

    fn add(&self, batch: &mut AlignedFaces, sample: Sample) -> Result<()> {
        let class = class_of(&sample, self.classes)?;
        let Some(Value::Image(image)) = sample.data.first() else {
            return Err(Error::invalid_input("the sample has no image; give one"));
        };
        let crop = match &self.finder {
            None => Some(whole_image(image, SIDE)),
            Some(finder) => {
                let mut faces = BoundingBoxList::default();
                finder.faces(image, &mut faces)?;
                largest_face(&faces).and_then(|face| finder.crop(image, face, SIDE))
            }
        };
        let crop = crop.ok_or_else(|| {
            Error::invalid_input(
                "the image has no face; remove it, or set picture to \"face\" when images are cropped faces",
            )
        })?;
        let start = batch.pixels.len();
        batch.pixels.resize(start + self.preprocess.len(), 0.0);
        let written = self.preprocess.warp_into(image.view(), &crop, &mut batch.pixels[start..]);
        match written {
            Ok(()) => batch.classes.push(class),
            Err(_) => batch.pixels.truncate(start),
        }
        written
    }
}

impl Objective for ArcFace {
    type Network = Network;
    type Collate = Collator;

    fn collate(&self) -> Result<Collator> {
        let preprocess = Preprocess::new(SIDE, SIDE);
        Ok(Collator { preprocess, classes: self.classes, finder: self.finder.clone() })
    }

    fn pipeline(&self) -> Result<Pipeline> {
        Pipeline::default().sometimes(0.5, Flip::default())
    }

    fn loss(&self, network: &Network, batch: &AlignedFaces, device: &Device) -> Result<Loss> {
        let count = batch.classes.len();
        let faces = TensorData::new(batch.pixels.clone(), [count, 3, SIDE, SIDE]);
        let cosines = network.cosines(network.embed(Tensor::<4>::from_data(faces, device)));
        let classes = Tensor::<1, Int>::from_data(TensorData::new(batch.classes.clone(), [count]), device);
        let own = classes.clone().one_hot::<2>(self.classes).float();
        // cos(angle + margin); beyond its minimum a line that keeps falling (the paper's code).
        let sines = (cosines.clone().powf_scalar(2.0).neg() + 1.0).clamp_min(1e-6).sqrt();
        let harder = cosines.clone() * self.margin.cos() - sines * self.margin.sin();
        let line = cosines.clone() - self.margin.sin() * self.margin;
        let turned = cosines.clone().lower_elem(-self.margin.cos());
        let harder = harder.mask_where(turned, line);
        let logits = (cosines.clone() + (harder - cosines) * own) * self.scale;
        Ok(CrossEntropyLossConfig::new().init(device).forward(logits, classes).into())
    }

    fn container(&self, network: &Network) -> Result<Container> {
        let input = Input::new("image", [1, 3, SIDE, SIDE]);
        let model = onnx(network, input, &["embedding"], Network::embed)?;
        let mut files = self.parts.clone();
        files.push(("model.onnx".to_owned(), model));
        files.push((TRAINABLE.to_owned(), bytes_from_network(network)?));
        Ok(Container { manifest: self.manifest.clone(), files })
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;
    use opendr_engine::data::Image;
    use opendr_engine::target::Category;
    use opendr_perception_testing::overfit::losses_on_one_batch;

    use super::*;

    #[test]
    fn one_batch_is_overfitted_and_exported() {
        let objective = ArcFace {
            classes: 3,
            margin: 0.5,
            scale: 16.0,
            finder: None,
            manifest: Manifest::new("face_recognition", ""),
            parts: vec![("detector/model.json".to_owned(), b"{}".to_vec())],
        };
        let samples = (0..6).map(|index| {
            let mut random = Random::new(index);
            let pixels = (0..28 * 28 * 3).map(|_| random.below(256) as u8).collect();
            let image = Image::from_rgb8(pixels, 28, 28).unwrap();
            let target = Some(Category::new(index as i64 % 3, None).into());
            Sample { data: vec![image.into()], target }
        });
        let network = |device: &Device| Network::new(3, 16, 0.1, device);
        let [before, after] = losses_on_one_batch(&objective, network, samples.collect(), 0.005);
        assert!(before > 2.0, "{before}");
        assert!(after < 0.05 * before, "{before} to {after}");

        let container = objective.container(&network(&Device::flex())).unwrap();
        let names: Vec<_> = container.files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["detector/model.json", "model.onnx", "network.bpk"]);
    }
}
