//! Moving average of a network's weights.

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param, ParamId};
use burn::optim::GradientsParams;
use burn::tensor::Tensor;

/// A network whose weights are the exponential moving average of those of another, `w = decay * w + (1 - decay) * other`
/// (Polyak and Juditsky 1992), including the statistics of batch normalisation.
pub struct Average<M> {
    network: M,
    decay: f64,
}

impl<M: Module> Average<M> {
    /// Starts at `network`, which is in its form for inference.
    pub fn new(network: M, decay: f64) -> Self {
        Self { network, decay }
    }

    /// Returns the averaged network.
    pub fn network(&self) -> &M {
        &self.network
    }

    /// Updates the average with the weights after step `step`, from 1; the decay is smaller in the first steps.
    pub fn update(self, latest: &M, step: u64) -> Self {
        let decay = self.decay.min((1.0 + step as f64) / (10.0 + step as f64));
        let mut weights = Weights(GradientsParams::new());
        latest.visit(&mut weights);
        let network = self.network.map(&mut Towards { weights: weights.0, decay });
        Self { network, decay: self.decay }
    }
}

/// Tensors by the id of their parameter.
struct Weights(GradientsParams);

impl ModuleVisitor for Weights {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.register(param.id, param.val());
    }
}

struct Towards {
    weights: GradientsParams,
    decay: f64,
}

impl Towards {
    fn moved<const D: usize>(&self, id: ParamId, average: Tensor<D>) -> Tensor<D> {
        match self.weights.get::<D>(id) {
            Some(latest) => average * self.decay + latest * (1.0 - self.decay),
            None => average,
        }
    }
}

impl ModuleMapper for Towards {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let id = param.id;
        param.map(|average| self.moved(id, average))
    }
}
