//! Burn's generic code for every kind of parameter and layer, compiled with this crate.
//!
//! The compiler uses instances of generic functions of a crate in those that depend on it, where it optimises for size or not at all. Each
//! crate with a network would have its own otherwise: 1.5 MB of a program with all learners.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv1d, Conv1dConfig, Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::nn::{
    BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Embedding, EmbeddingConfig, LayerNorm,
    LayerNormConfig,
};
use burn::nn::{Linear, LinearConfig};
use burn::tensor::{Device, Tensor};
use opendr_datasets::loader::SampleBatches;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result};

use crate::trained_network::{NetworkOf, TrainedNetwork};
use crate::{Container, Loss, Objective};

#[derive(Module, Debug)]
struct AllKinds {
    vector: Param<Tensor<1>>,
    matrix: Param<Tensor<2>>,
    volume: Option<Param<Tensor<3>>>,
    kernel: Vec<Param<Tensor<4>>>,
    kernel_3d: Param<Tensor<5>>,
    linear: Linear,
    linears: Vec<Linear>,
    optional: Option<Linear>,
    sequence: Conv1d,
    image: Conv2d,
    images: Vec<Conv2d>,
    optional_image: Option<Conv2d>,
    transposed: ConvTranspose2d,
    norm: BatchNorm,
    norms: Vec<BatchNorm>,
    optional_norm: Option<BatchNorm>,
    layer_norm: LayerNorm,
    embedding: Embedding,
    dropout: Dropout,
}

impl AllKinds {
    fn new(device: &Device) -> Self {
        Self {
            vector: Param::from_tensor(Tensor::zeros([1], device)),
            matrix: Param::from_tensor(Tensor::zeros([1; 2], device)),
            volume: Some(Param::from_tensor(Tensor::zeros([1; 3], device))),
            kernel: vec![Param::from_tensor(Tensor::zeros([1; 4], device))],
            kernel_3d: Param::from_tensor(Tensor::zeros([1; 5], device)),
            linear: LinearConfig::new(1, 1).init(device),
            linears: vec![LinearConfig::new(1, 1).init(device)],
            optional: Some(LinearConfig::new(1, 1).init(device)),
            sequence: Conv1dConfig::new(1, 1, 1).init(device),
            image: Conv2dConfig::new([1, 1], [1, 1]).init(device),
            images: vec![Conv2dConfig::new([1, 1], [1, 1]).init(device)],
            optional_image: Some(Conv2dConfig::new([1, 1], [1, 1]).init(device)),
            transposed: ConvTranspose2dConfig::new([1, 1], [1, 1]).init(device),
            norm: BatchNormConfig::new(1).init(device),
            norms: vec![BatchNormConfig::new(1).init(device)],
            optional_norm: Some(BatchNormConfig::new(1).init(device)),
            layer_norm: LayerNormConfig::new(1).init(device),
            embedding: EmbeddingConfig::new(1, 1).init(device),
            dropout: DropoutConfig::new(0.5).init(),
        }
    }
}

/// An objective whose network is never trained.
struct Untrained;

impl Objective for Untrained {
    type Network = AllKinds;
    type Collate = SampleBatches;

    fn collate(&self) -> Result<SampleBatches> {
        Ok(SampleBatches)
    }

    fn loss(&self, _: &AllKinds, _: &Vec<Sample>, _: &Device) -> Result<Loss> {
        Err(Error::internal("this network is never trained"))
    }

    fn container(&self, _: &AllKinds) -> Result<Container> {
        Err(Error::internal("this network is never trained"))
    }
}

/// Returns the number of files of a checkpoint of a network with every kind of layer.
///
/// # Errors
/// When a record cannot be serialised.
#[doc(hidden)]
pub fn files_of_all_kinds(device: &Device) -> Result<usize> {
    let network = NetworkOf::new(&Untrained, AllKinds::new(device), true, &device.clone().autodiff());
    let network: &dyn TrainedNetwork = &network;
    Ok(network.files()?.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_network_with_every_kind_of_layer_has_a_checkpoint() {
        assert_eq!(files_of_all_kinds(&Device::flex()).unwrap(), 2);
    }
}
