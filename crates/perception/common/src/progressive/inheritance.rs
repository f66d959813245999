//! Weights of a network in a larger one.

use std::collections::HashMap;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param, ParamId};
use burn::optim::GradientsParams;
use burn::tensor::Tensor;

/// Name of the last layer of a network, whose inputs are others when a layer is added.
const CLASSIFIER: &str = "classifier";

/// Returns `network` with the weights of `smaller` in the first rows and columns of its own; the others are unchanged. With
/// `is_deeper`, the layer `classifier` is unchanged.
pub(super) fn inherited<M: Module>(network: M, smaller: &M, is_deeper: bool) -> M {
    let mut weights = Weights::default();
    smaller.visit(&mut weights);
    network.map(&mut Inheritance { weights, path: Vec::new(), is_deeper })
}

/// Tensors by the path of their parameter.
#[derive(Default)]
struct Weights {
    path: Vec<String>,
    ids: HashMap<String, ParamId>,
    tensors: GradientsParams,
}

impl ModuleVisitor for Weights {
    fn enter_module(&mut self, name: &str, _: &str) {
        self.path.push(name.to_owned());
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.pop();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.ids.insert(self.path.join("."), param.id);
        self.tensors.register(param.id, param.val());
    }
}

struct Inheritance {
    weights: Weights,
    path: Vec<String>,
    is_deeper: bool,
}

impl ModuleMapper for Inheritance {
    fn enter_module(&mut self, name: &str, _: &str) {
        self.path.push(name.to_owned());
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.pop();
    }

    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let is_other = self.is_deeper && self.path.first().is_some_and(|name| name == CLASSIFIER);
        let id = self.weights.ids.get(&self.path.join(".")).filter(|_| !is_other);
        match id.and_then(|id| self.weights.tensors.get::<D>(*id)) {
            Some(smaller) => param.map(|tensor| with_part(tensor, smaller)),
            None => param,
        }
    }
}

/// Returns `tensor` with `part` in its first rows and columns, if it fits there.
fn with_part<const D: usize>(tensor: Tensor<D>, part: Tensor<D>) -> Tensor<D> {
    let (whole, inner) = (tensor.dims(), part.dims());
    match inner.iter().zip(&whole).all(|(inner, whole)| inner <= whole) {
        true => tensor.slice_assign(inner.map(|size| 0..size), part),
        false => tensor,
    }
}

#[cfg(test)]
mod tests {
    use burn::nn::{BatchNorm, BatchNormConfig, Linear, LinearConfig};
    use burn::tensor::Device;

    use super::*;

    #[derive(Module, Debug)]
    struct Network {
        layers: Vec<Linear>,
        norm: BatchNorm,
        classifier: Linear,
    }

    impl Network {
        fn new(widths: &[usize], device: &Device) -> Self {
            let mut inputs = 3;
            let layers = widths.iter().map(|width| {
                let layer = LinearConfig::new(inputs, *width).init(device);
                inputs = *width;
                layer
            });
            let layers = layers.collect();
            Self {
                layers,
                norm: BatchNormConfig::new(inputs).init(device),
                classifier: LinearConfig::new(inputs, 2).init(device),
            }
        }
    }

    fn rows(tensor: &Tensor<2>, rows: usize, columns: usize) -> Vec<f32> {
        tensor.clone().slice([0..rows, 0..columns]).into_data().try_to_vec().unwrap()
    }

    #[test]
    fn a_wider_network_keeps_the_weights_of_the_smaller_one() {
        let device = Device::flex();
        let (wide, smaller) = (Network::new(&[5, 4], &device), Network::new(&[5, 2], &device));
        let (own, old) = (wide.layers[1].weight.val(), smaller.layers[1].weight.val());
        let network = inherited(wide, &smaller, false);
        let layer = network.layers[1].weight.val();
        assert_eq!(rows(&layer, 5, 2), rows(&old, 5, 2));
        let added = |weights: &Tensor<2>| weights.clone().slice([0..5, 2..4]).into_data();
        assert_eq!(added(&layer), added(&own), "added channels keep their initial weights");
        assert_eq!(
            rows(&network.classifier.weight.val(), 2, 2),
            rows(&smaller.classifier.weight.val(), 2, 2)
        );
        assert_eq!(network.norm.running_mean.value().dims(), [4]);
    }

    #[test]
    fn a_deeper_network_has_a_new_classifier() {
        let device = Device::flex();
        let (deep, smaller) = (Network::new(&[5, 2], &device), Network::new(&[5], &device));
        let own = deep.classifier.weight.val();
        let network = inherited(deep, &smaller, true);
        assert_eq!(rows(&network.layers[0].weight.val(), 3, 5), rows(&smaller.layers[0].weight.val(), 3, 5));
        assert_eq!(network.classifier.weight.val().into_data(), own.into_data());
    }
}
