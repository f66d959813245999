//! The direction to the best view, from a single view.

use opendr_engine::data::Image;
use opendr_engine::rig::ViewPose;
use opendr_engine::{Error, Result};

use super::frame::in_rig_frame;
use crate::fusion::log_sum;
use crate::view_network::{ViewNetwork, ViewNetworkConfig};

/// Number of components of an estimate.
pub(super) const COMPONENTS: usize = 3;
/// Numbers of a component: natural parameter and logarithm of the weight.
pub(super) const NUMBERS: usize = 4;
/// Maximum concentration: a deviation of about 6 degrees.
const SHARPEST: f32 = 100.0;

/// Estimates from one view in which direction from the subject the best camera pose is.
///
/// The side of a long subject looks alike whether its front is to the left or to the right, so that an estimate is a mixture of three
/// von Mises-Fisher distributions over directions, with densities proportional to `exp(eta . direction)`, in the camera's frame (x
/// from the subject to the camera, z up).
#[derive(Debug, Clone)]
pub struct BestViewEstimator(ViewNetwork);

/// A distribution over directions to the best view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestViewEstimate {
    /// Natural parameter of each component: mean direction times concentration.
    etas: [[f32; 3]; COMPONENTS],
    /// Logarithm of weight times normalisation of each component.
    logs: [f32; COMPONENTS],
}

impl BestViewEstimator {
    pub(super) fn new(network: ViewNetwork) -> Self {
        Self(network)
    }

    /// Returns the sizes of the network.
    pub fn config(&self) -> &ViewNetworkConfig {
        self.0.config()
    }

    /// Returns the parameters as little-endian `f16`.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.0.to_bytes()
    }

    /// Creates an estimator from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// Returns `InvalidParam` for sizes out of range, `Format` for bytes that do not fit them and for a network without 12 outputs.
    pub fn from_bytes(config: ViewNetworkConfig, bytes: &[u8]) -> Result<Self> {
        if config.outputs != NUMBERS * COMPONENTS {
            return Err(Error::format(format!(
                "an estimator of the best view with {} outputs instead of 12: train the model again",
                config.outputs
            )));
        }
        ViewNetwork::from_bytes("the estimator of the best view", config, 0, bytes).map(Self)
    }

    /// Estimates the direction from an image.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an image that is not of 8 bits, `Internal` if damaged parameters give numbers that are not finite.
    pub fn estimate(&mut self, image: &Image) -> Result<BestViewEstimate> {
        let (outputs, _) = self.0.forward(image)?;
        let estimate = BestViewEstimate::of(outputs);
        let is_finite = outputs.iter().all(|output| output.is_finite());
        is_finite.then_some(estimate).ok_or_else(|| {
            Error::internal("the estimator of the best view returned numbers that are not finite, its parameters are damaged; load or train it again")
        })
    }
}

impl BestViewEstimate {
    /// Creates an estimate from the outputs of the network.
    pub(super) fn of(outputs: &[f32]) -> Self {
        let components = outputs.as_chunks::<NUMBERS>().0;
        let sum = log_sum(components.iter().map(|[.., weight]| *weight));
        let mut estimate = Self { etas: [[0.0; 3]; COMPONENTS], logs: [0.0; COMPONENTS] };
        for ((eta, log), [x, y, z, weight]) in
            estimate.etas.iter_mut().zip(&mut estimate.logs).zip(components)
        {
            let kappa = length([*x, *y, *z]);
            let scale = (SHARPEST / kappa.max(SHARPEST)).min(1.0);
            *eta = [*x, *y, *z].map(|part| scale * part);
            *log = weight - sum - log_normaliser(kappa.min(SHARPEST));
        }
        estimate
    }

    /// Returns the same distribution in the frame of the rig whose camera is at `pose`.
    pub fn in_rig_frame(self, pose: &ViewPose) -> Self {
        Self { etas: self.etas.map(|eta| in_rig_frame(pose, eta)), ..self }
    }

    /// Returns the density in a direction of length 1, per steradian.
    pub fn density(&self, direction: [f32; 3]) -> f32 {
        self.logs(direction).map(f32::exp).iter().sum()
    }

    /// Returns the logarithm of each component's share of the density in a direction.
    pub(super) fn logs(&self, direction: [f32; 3]) -> [f32; COMPONENTS] {
        std::array::from_fn(|at| {
            let along: f32 = self.etas[at].iter().zip(direction).map(|(a, b)| a * b).sum();
            self.logs[at] + along
        })
    }
}

/// Euclidean length.
pub(super) fn length(vector: [f32; 3]) -> f32 {
    vector.iter().map(|part| part * part).sum::<f32>().sqrt()
}

/// Logarithm of the integral of `exp(kappa cos(angle))` over all directions: `4 pi sinh(kappa) / kappa`, without overflow.
fn log_normaliser(kappa: f32) -> f32 {
    let kappa = kappa.max(1e-3);
    kappa + (-(-2.0 * kappa).exp()).ln_1p() - (2.0 * kappa).ln() + (4.0 * std::f32::consts::PI).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_integrate_to_one() {
        let outputs = [3.0, -1.0, 2.0, 0.5, 0.0, 0.0, 0.0, -1.0, -20.0, 40.0, 1.0, 0.0];
        let estimate = BestViewEstimate::of(&outputs);
        let (rings, turns) = (400, 400);
        let mut sum = 0.0;
        for ring in 0..rings {
            let z = 2.0 * (f64::from(ring) + 0.5) / f64::from(rings) - 1.0;
            for turn in 0..turns {
                let ((sine, cosine), level) = (
                    (std::f64::consts::TAU * f64::from(turn) / f64::from(turns)).sin_cos(),
                    (1.0 - z * z).sqrt(),
                );
                let direction = [level * cosine, level * sine, z].map(|part| part as f32);
                sum += f64::from(estimate.density(direction));
            }
        }
        let integral = sum * 4.0 * std::f64::consts::PI / f64::from(rings * turns);
        assert!((integral - 1.0).abs() < 2e-3, "{integral}");
    }
}
