//! Gradients of a whole network.

use burn::module::{Module, ModuleVisitor, Param};
use burn::optim::GradientsParams;
use burn::tensor::{ElementConversion, Tensor};

/// Returns the Euclidean norm of all gradients together.
pub fn gradient_norm<M: Module>(network: &M, gradients: &GradientsParams) -> f64 {
    let mut norm = Norm { gradients, square: None };
    network.visit(&mut norm);
    norm.square.map_or(0.0, |square| square.into_scalar::<f32>().elem::<f64>().sqrt())
}

/// Returns all gradients multiplied by `factor`.
pub fn scaled<M: Module>(network: &M, gradients: GradientsParams, factor: f64) -> GradientsParams {
    let mut scale = Scale { gradients, scaled: GradientsParams::new(), factor };
    network.visit(&mut scale);
    scale.scaled
}

struct Norm<'a> {
    gradients: &'a GradientsParams,
    square: Option<Tensor<1>>,
}

impl ModuleVisitor for Norm<'_> {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let Some(gradient) = self.gradients.get::<D>(param.id) else { return };
        let square = gradient.square().sum();
        self.square = Some(match self.square.take() {
            Some(sum) => sum + square,
            None => square,
        });
    }
}

struct Scale {
    gradients: GradientsParams,
    scaled: GradientsParams,
    factor: f64,
}

impl ModuleVisitor for Scale {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        if let Some(gradient) = self.gradients.remove::<D>(param.id) {
            self.scaled.register(param.id, gradient * self.factor);
        }
    }
}
