//! Training objective of VPIT.

use burn::tensor::activation::log_sigmoid;
use burn::tensor::{Device, Tensor, TensorData};
use opendr_engine::Result;
use opendr_engine::learner::Learner;
use opendr_engine::model::Manifest;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::layout::{CHANNELS, PLACES, TEMPLATE, VIEW, VpitLayout};
use super::network::VpitNetwork;
use super::pairs::{VpitBatch, VpitBatches};
use super::{FILE, Vpit};

/// Training objective of VPIT.
#[derive(Debug)]
pub struct VpitObjective {
    /// Sizes of a view.
    pub layout: VpitLayout,
    /// Margin around an object, in its mean sides.
    pub context: f64,
    /// Maximum number of objects per pair of scans.
    pub objects: usize,
    /// Whether views are shifted and rotated at random.
    pub augment: bool,
}

impl Objective for VpitObjective {
    type Network = VpitNetwork;
    type Collate = VpitBatches;

    fn collate(&self) -> Result<VpitBatches> {
        let Self { layout, context, objects, augment } = *self;
        Ok(VpitBatches { layout, context, objects, augment })
    }

    fn loss(&self, network: &VpitNetwork, batch: &VpitBatch, device: &Device) -> Result<Loss> {
        if batch.pairs == 0 {
            let nothing = network.features(Tensor::zeros([1, CHANNELS, VIEW, VIEW], device));
            return Ok((nothing.sum() * 0.0).into());
        }
        let tensor = |numbers: &[f32], shape: [usize; 4]| {
            Tensor::<4>::from_data(TensorData::new(numbers.to_vec(), shape), device)
        };
        let pairs = batch.pairs;
        // One forward pass for both, which share the batch normalisation.
        let views = [batch.templates.as_slice(), &batch.views].concat();
        let features = network.features(tensor(&views, [2 * pairs, CHANNELS, VIEW, VIEW]));
        let [templates, views] = [0..pairs, pairs..2 * pairs].map(|part| features.clone().slice([part]));
        let shares = tensor(&batch.shares, [pairs, 1, TEMPLATE, TEMPLATE]);
        let logits = network.compare(templates, shares, views).reshape([pairs * PLACES * PLACES]);
        let [labels, weights] =
            [&batch.labels, &batch.weights].map(|numbers| Tensor::<1>::from_floats(&numbers[..], device));
        let right = log_sigmoid(logits.clone()) * labels.clone();
        let wrong = log_sigmoid(-logits) * (-labels + 1.0);
        Ok((-((right + wrong) * weights).sum() / pairs as f64).into())
    }

    fn container(&self, network: &VpitNetwork) -> Result<Container> {
        let input = Input::new("views", [1, CHANNELS, VIEW, VIEW]).open(0);
        let features = export::onnx(network, input, &["features"], |network, views| network.features(views))?;
        let [scale, bias] = network.scale_and_bias();
        let mut manifest = Manifest::new(Vpit::SPEC.name, "");
        manifest.task = Some(Vpit::SPEC.task);
        manifest.write_inputs(&VpitLayout { scale, bias, ..self.layout })?;
        let files = vec![(FILE.to_owned(), features), (TRAINABLE.to_owned(), bytes_from_network(network)?)];
        Ok(Container { manifest, files })
    }
}
