//! Estimation of the feedforward that one axis lacks.

use super::AdaptationParams;
use super::response::{Response, Stages};

/// Estimates the weights of the features with which the observed velocity follows the reference model.
///
/// The reference model moves under the reference's acceleration at once and under the feedback as late as the nominal plant. What
/// the observed velocity lacks of it is explained by features behind the same response: a Kalman filter whose weights are an
/// Ornstein-Uhlenbeck process about 0, with a fast constant (loads and gusts) and slow functions of the reference (mass, drag, lag).
/// The shift that the weights caused so far is counted in, so that the estimate closes no loop where the response is exact.
#[derive(Debug, Clone)]
pub(super) struct AxisEstimator {
    response: Response,
    /// Of each feature.
    pub weights: Vec<f32>,
    /// By rows; symmetric.
    covariance: Vec<f32>,
    /// Features behind the response.
    filtered: Vec<Stages>,
    /// The shift of the command behind the response.
    shift: Stages,
    /// The feedback behind the response.
    feedback: Stages,
    /// Velocity of the reference model, and by how much the observed one lacks of it.
    model: f32,
    lacking: f32,
    gain: Vec<f32>,
}

/// Variance and time constant of each weight.
fn prior(params: &AdaptationParams, feature: usize) -> [f32; 2] {
    let (deviation, time) = match feature {
        0 => (params.load, params.load_time),
        _ => (params.feature, params.feature_time),
    };
    [deviation * deviation, time]
}

impl AxisEstimator {
    pub fn new(params: &AdaptationParams, features: usize, response: f32, period: f32) -> Self {
        let mut covariance = vec![0.0; features * features];
        (0..features).for_each(|at| covariance[at * features + at] = prior(params, at)[0]);
        Self {
            response: Response::new(response, params.observer, period),
            weights: vec![0.0; features],
            covariance,
            filtered: vec![[0.0; 3]; features],
            shift: [0.0; 3],
            feedback: [0.0; 3],
            model: 0.0,
            lacking: 0.0,
            gain: vec![0.0; features],
        }
    }

    /// Forgets the past of the last episode; the weights and their covariance stay.
    pub fn reset(&mut self) {
        self.filtered.fill([0.0; 3]);
        (self.shift, self.feedback, self.lacking) = ([0.0; 3], [0.0; 3], 0.0);
    }

    /// Takes in the commands of a step: the reference's acceleration as old as the velocity that will be observed, the base's
    /// feedback, and the features with which its command was shifted.
    pub fn command(&mut self, feedforward: f32, feedback: f32, features: &[f32], slope: f32, period: f32) {
        self.response.advance(&mut self.feedback, feedback);
        let mut shift = 0.0;
        for ((stages, feature), weight) in self.filtered.iter_mut().zip(features).zip(&self.weights) {
            self.response.advance(stages, slope * feature);
            shift += slope * feature * weight;
        }
        self.response.advance(&mut self.shift, shift);
        self.model += (feedforward + self.feedback[1]) * period;
    }

    /// Takes in an observed velocity; without `fresh` what lacks stays as it was.
    pub fn observe(&mut self, velocity: f32, observer: f32, period: f32, fresh: bool) {
        if fresh {
            self.lacking = self.model - velocity;
        }
        self.model = velocity + self.lacking * (1.0 - observer * period).max(0.0);
    }

    /// Moves the weights by an innovation of the filter, times `sign`.
    pub fn learn(&mut self, params: &AdaptationParams, period: f32, sign: f32) {
        let count = self.weights.len();
        let predicted: f32 =
            self.filtered.iter().zip(&self.weights).map(|(stages, weight)| stages[2] * weight).sum();
        let innovation = params.observer * self.lacking + self.shift[2] - predicted;
        let innovation = innovation.clamp(-params.innovation_limit, params.innovation_limit);
        for (gain, row) in self.gain.iter_mut().zip(self.covariance.chunks_exact(count)) {
            *gain = row.iter().zip(&self.filtered).map(|(own, stages)| own * stages[2]).sum();
        }
        let spread: f32 = self.gain.iter().zip(&self.filtered).map(|(gain, stages)| gain * stages[2]).sum();
        let certainty = 1.0 / (params.noise * params.noise + spread);
        let kept = 1.0 - params.leak * period;
        for (weight, gain) in self.weights.iter_mut().zip(&self.gain) {
            *weight = kept * *weight + sign * gain * certainty * innovation;
        }
        for (at, row) in self.covariance.chunks_exact_mut(count).enumerate() {
            let [variance, time] = prior(params, at);
            let own = self.gain[at] * certainty;
            let forgotten = period / time;
            for (other, (covariance, gain)) in row.iter_mut().zip(&self.gain).enumerate() {
                let others = period / prior(params, other)[1];
                *covariance = (*covariance - own * gain) * (1.0 - forgotten - others);
            }
            row[at] += 2.0 * forgotten * variance;
        }
    }
}
