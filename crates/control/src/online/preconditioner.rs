//! Decorrelation of the last layer's inputs.

use opendr_engine::{Error, Result};

use super::AdaptablePolicy;
use crate::TrackingLayout;
use crate::matrix::Dense;

/// The inverse of the covariance of a last layer's inputs over observations of the training, for steps in the natural gradient.
///
/// The inputs of a last layer (the activations of the last hidden layer, and 1) are highly correlated: plain gradient steps learn
/// constant loads fast and everything else slowly. Multiplied by this matrix the gradient learns all that the observations
/// distinguish equally fast (Amari, 1998).
#[derive(Debug, Clone, PartialEq)]
pub struct Preconditioner {
    /// Inputs of the last layer, with the 1 of its bias.
    size: usize,
    /// By rows; symmetric.
    inverse: Vec<f32>,
}

impl Preconditioner {
    /// From `observations`, rows as they occur in operation, with errors of 0 where `reference_only`; `ridge` is the share of the mean variance that is
    /// added to every direction, so that directions of noise do not count; `constant` is how many directions constant loads count for
    /// beside what the observations distinguish.
    ///
    /// # Errors
    /// `InvalidInput` without a row, `Unsupported` for a policy without a dense last layer, and those of the policy.
    pub fn of<P: AdaptablePolicy>(
        policy: &mut P,
        observations: &[f32],
        layout: &TrackingLayout,
        reference_only: bool,
        [ridge, constant]: [f64; 2],
    ) -> Result<Self> {
        let TrackingLayout { len, axes, .. } = *layout;
        let range = policy.last_layer();
        let size = range.len() / axes.max(1);
        if size == 0 || size * axes != range.len() {
            return Err(Error::unsupported(format!(
                "a last layer of {} parameters is no dense one of {axes} outputs; adapt without a preconditioner",
                range.len()
            )));
        }
        if len == 0 || observations.len() < len {
            return Err(Error::invalid_input("no observation; give those of flights of the base"));
        }
        let (mut action, mut unit) = (vec![0.0; axes], vec![0.0; axes]);
        unit[0] = 1.0;
        let mut gradients = vec![0.0; policy.parameters().len()];
        let mut covariance = vec![0.0; size * size];
        let rows = observations.chunks_exact(len);
        let share = 1.0 / rows.len() as f64;
        let mut observation = vec![0.0; len];
        for row in rows {
            observation.copy_from_slice(row);
            if reference_only {
                layout.clear_errors(&mut observation);
            }
            policy.act(&observation, &mut action)?;
            gradients.fill(0.0);
            policy.backward(&unit, true, &mut gradients)?;
            let inputs = || gradients[range.clone()].iter().step_by(axes).map(|input| f64::from(*input));
            for (own, one) in covariance.chunks_exact_mut(size).zip(inputs()) {
                own.iter_mut().zip(inputs()).for_each(|(sum, other)| *sum += share * one * other);
            }
        }
        let last = size * size - 1;
        let bias = covariance[last].max(1e-12);
        let mean = (0..size).map(|at| covariance[at * size + at]).sum::<f64>() / size as f64;
        (0..size).for_each(|at| covariance[at * size + at] += ridge * mean + 1e-12);
        let mut identity = vec![0.0; size * size];
        (0..size).for_each(|at| identity[at * size + at] = 1.0);
        let inverse = Dense::new(size, size, &covariance)?.solve(&Dense::new(size, size, &identity)?);
        let mut inverse = inverse.ok_or_else(|| {
            Error::invalid_input(
                "the last layer's inputs are constant; give observations that vary, or a larger ridge",
            )
        })?;
        inverse.numbers[last] += constant / bias;
        Ok(Self { size, inverse: inverse.numbers.iter().map(|number| *number as f32).collect() })
    }

    /// Writes the inverse times `gradients` of a last layer, `[size, axes]`, into `direction`.
    ///
    /// The gradients of one observation are the outer product of the layer's inputs and the gradients of its outputs, which stand in
    /// the row of the bias; so one product with a vector suffices.
    pub(super) fn apply(&self, gradients: &[f32], direction: &mut [f32], product: &mut Vec<f32>) {
        let axes = gradients.len() / self.size;
        let outputs = &gradients[gradients.len() - axes..];
        let larger = |best: usize, at: usize| if outputs[at].abs() > outputs[best].abs() { at } else { best };
        let axis = (1..axes).fold(0, larger);
        product.clear();
        product.resize(self.size, 0.0);
        if outputs[axis] == 0.0 {
            return direction.fill(0.0);
        }
        for (row, weights) in self.inverse.chunks_exact(self.size).enumerate() {
            let input = gradients[row * axes + axis] / outputs[axis];
            product.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += input * weight);
        }
        for (to, part) in direction.chunks_exact_mut(axes).zip(&*product) {
            to.iter_mut().zip(outputs).for_each(|(to, output)| *to = part * output);
        }
    }

    /// Whether it belongs to a last layer of so many parameters for so many axes.
    pub(super) fn fits(&self, parameters: usize, axes: usize) -> bool {
        self.size * axes == parameters
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The short way by the outer product is the product of the matrices.
    #[test]
    fn the_direction_is_the_matrix_times_the_gradients() {
        let inverse = vec![2.0, 0.5, -0.1, 0.5, 1.0, 0.3, -0.1, 0.3, 4.0];
        let preconditioner = Preconditioner { size: 3, inverse: inverse.clone() };
        let (inputs, outputs) = ([0.7f32, -0.4, 1.0], [0.2f32, -3.0]);
        let gradients: Vec<f32> =
            inputs.iter().flat_map(|input| outputs.map(|output| input * output)).collect();
        let (mut direction, mut product) = (vec![9.0; 6], Vec::new());
        preconditioner.apply(&gradients, &mut direction, &mut product);
        for row in 0..3 {
            for axis in 0..2 {
                let expected: f32 = (0..3).map(|at| inverse[3 * row + at] * gradients[2 * at + axis]).sum();
                assert!((direction[2 * row + axis] - expected).abs() < 1e-5);
            }
        }
        preconditioner.apply(&[0.0; 6], &mut direction, &mut product);
        assert_eq!(direction, [0.0; 6]);
        assert!(preconditioner.fits(6, 2) && !preconditioner.fits(6, 3));
    }
}
