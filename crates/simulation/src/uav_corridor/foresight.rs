//! How flights end after each possible step.

use opendr_engine::{Error, Result};

use super::lookahead::{CANDIDATES, Candidate};
use super::map_raster::MapRaster;
use super::way_costs::WayCosts;
use super::{FINISH, HALF_TRACK, START, TURN};
use crate::sine_cosine::sine_cosine;

/// The probability that a flight fails after each first step, learnt from simulated flights that took every step from the same
/// place and then followed the planner (rollout classification; Lagoudakis and Parr, Reinforcement learning as classification,
/// 2003).
///
/// An ensemble of networks with one hidden layer, from [`FEATURES`](Self::FEATURES) numbers of a step to the logit of a failure; a single
/// network is too certain about the step that it rates best.
#[derive(Debug, Clone, PartialEq)]
pub struct Foresight {
    parameters: Vec<f32>,
}

/// Weight of the planner's costs (metres) beside the probability of a failure.
const PATIENCE: f32 = 0.2;

/// Distances along and beside the first metre, then distances and bearings after it, at which the map is read.
const ALONG: [f32; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
const BESIDE: [f32; 3] = [-0.3, 0.0, 0.3];
const AFTER: [f32; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
const BEARINGS: usize = 7;
const FAN: usize = AFTER.len() * BEARINGS;
const OWN: usize = 9;
/// Those of a step's own features whose sign is that of a side.
const SIGNED: std::ops::Range<usize> = 3..8;

/// The place from which a step begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outset {
    pub x: f32,
    pub offset: f32,
    pub yaw: f64,
}

impl Foresight {
    /// Number of features of a step.
    pub const FEATURES: usize = OWN + ALONG.len() * BESIDE.len() + 3 * FAN;
    /// Neurons of the hidden layer.
    pub const HIDDEN: usize = 48;
    /// Networks of the ensemble.
    pub const MEMBERS: usize = 4;
    /// Number of parameters of a network: weights `[FEATURES, HIDDEN]`, biases, weights `[HIDDEN]`, bias.
    pub const PARAMETERS: usize = (Self::FEATURES + 1) * Self::HIDDEN + Self::HIDDEN + 1;

    /// Mirrors the features of a step at the middle line of the corridor: what is to the left is then to the right.
    pub fn mirror(features: &mut [f32; Self::FEATURES]) {
        let (own, rest) = features.split_at_mut(OWN);
        own[SIGNED].iter_mut().for_each(|number| *number = -*number);
        let (path, fan) = rest.split_at_mut(ALONG.len() * BESIDE.len());
        path.chunks_exact_mut(BESIDE.len()).for_each(<[f32]>::reverse);
        fan.chunks_exact_mut(3 * BEARINGS).for_each(|row| row.as_chunks_mut::<3>().0.reverse());
    }

    /// Creates the ensemble from the parameters of its networks, one after the other.
    ///
    /// # Errors
    /// `Format` when they are of another number or not finite.
    pub fn new(parameters: Vec<f32>) -> Result<Self> {
        let count = Self::MEMBERS * Self::PARAMETERS;
        if parameters.len() == count && parameters.iter().all(|parameter| parameter.is_finite()) {
            return Ok(Self { parameters });
        }
        Err(Error::format(format!(
            "{} parameters of a foresight; {count} finite ones belong there, train the policy again",
            parameters.len()
        )))
    }

    /// Returns all parameters.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// Returns the probability of a failure: the mean of the networks.
    pub fn probability(&self, features: &[f32; Self::FEATURES]) -> f32 {
        let members = self.parameters.chunks_exact(Self::PARAMETERS);
        members.map(|member| member_probability(member, features)).sum::<f32>() / Self::MEMBERS as f32
    }

    /// Returns the step of the smallest risk: probability of a failure and detour.
    pub(super) fn choose(
        &self,
        candidates: &[Candidate; CANDIDATES],
        costs: &WayCosts,
        raster: &MapRaster,
        outset: Outset,
    ) -> [f32; 2] {
        let least = least_cost(candidates);
        let (mut smallest, mut action) = (f32::INFINITY, [0.0; 2]);
        let mut features = [0.0; Self::FEATURES];
        for candidate in candidates.iter().filter(|candidate| candidate.cost.is_finite()) {
            step_features(candidate, least, costs, raster, outset, &mut features);
            let risk = self.probability(&features) + PATIENCE * (candidate.cost - least);
            if risk < smallest {
                (smallest, action) = (risk, candidate.action);
            }
        }
        action
    }
}

fn member_probability(member: &[f32], features: &[f32; Foresight::FEATURES]) -> f32 {
    let (first, rest) = member.split_at(Foresight::FEATURES * Foresight::HIDDEN);
    let (biases, rest) = rest.split_at(Foresight::HIDDEN);
    let (second, last) = rest.split_at(Foresight::HIDDEN);
    let mut hidden = [0.0; Foresight::HIDDEN];
    hidden.copy_from_slice(biases);
    for (feature, row) in features.iter().zip(first.as_chunks::<{ Foresight::HIDDEN }>().0) {
        for (neuron, weight) in hidden.iter_mut().zip(row) {
            *neuron += feature * weight;
        }
    }
    let sum: f32 = hidden.iter().zip(second).map(|(neuron, weight)| neuron.max(0.0) * weight).sum();
    1.0 / (1.0 + (-(last[0] + sum)).exp())
}

/// Returns the cost of the cheapest candidate.
pub(super) fn least_cost(candidates: &[Candidate; CANDIDATES]) -> f32 {
    candidates.iter().map(|candidate| candidate.cost).fold(f32::INFINITY, f32::min)
}

/// Writes the features of a first step.
pub(super) fn step_features(
    candidate: &Candidate,
    least: f32,
    costs: &WayCosts,
    raster: &MapRaster,
    outset: Outset,
    features: &mut [f32; Foresight::FEATURES],
) {
    let ([heading, turn], [east, north]) = (candidate.action, candidate.direction);
    let yaw = outset.yaw + f64::from(turn) * TURN;
    let left = FINISH - outset.x;
    let (own, rest) = features.split_at_mut(OWN);
    own.copy_from_slice(&[
        (candidate.cost - least).min(10.0) * 0.2,
        ((least - left.clamp(0.0, 10.0)) * 0.2).clamp(-1.0, 2.0),
        f32::from(candidate.cost > 50.0),
        heading,
        turn,
        yaw as f32,
        outset.yaw as f32,
        (outset.offset + north) / HALF_TRACK,
        (outset.x - START) / (FINISH - START),
    ]);
    let weight = |place: [f32; 2]| (costs.weight(place) - 1.0) * 0.2;
    let (path, fan) = rest.split_at_mut(ALONG.len() * BESIDE.len());
    for (row, ahead) in path.as_chunks_mut::<{ BESIDE.len() }>().0.iter_mut().zip(ALONG) {
        *row = BESIDE.map(|beside| weight([ahead * east - beside * north, ahead * north + beside * east]));
    }
    let here = costs.at([east, north]);
    for (number, values) in fan.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        let bearing = (number % BEARINGS) as f64 - (BEARINGS / 2) as f64;
        let (sine, cosine) = sine_cosine(yaw + bearing * TURN);
        let away = AFTER[number / BEARINGS];
        let place = [east + away * cosine as f32, north + away * sine as f32];
        let nearer = ((costs.at(place) - here) / away).clamp(-2.0, 2.0);
        *values = [weight(place), raster.unknown(place), nearer];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uav_corridor::lookahead::Lookahead;

    #[test]
    fn it_is_a_mean_of_networks() {
        let count = Foresight::MEMBERS * Foresight::PARAMETERS;
        assert!(Foresight::new(vec![0.0; count - 1]).is_err());
        assert!(Foresight::new(vec![f32::NAN; count]).is_err());
        let mut parameters = vec![0.0; count];
        // The first network is certain of a failure, the others do not know.
        parameters[Foresight::PARAMETERS - 1] = 50.0;
        let foresight = Foresight::new(parameters).unwrap();
        let wanted = 0.5 + 0.5 / Foresight::MEMBERS as f32;
        assert!((foresight.probability(&[0.3; Foresight::FEATURES]) - wanted).abs() < 1e-6);
    }

    #[test]
    fn features_of_mirrored_places_are_mirrored() {
        let around = |points: &[[f32; 2]], offset: f32, yaw: f64, candidate: usize| {
            let mut costs = WayCosts::default();
            costs.find(points.iter().copied(), offset, 20.0);
            let mut raster = MapRaster::default();
            raster.draw(&[], points, [0.0, offset]);
            let candidates = Lookahead::default().candidates(&costs, points, yaw);
            let mut features = [0.0; Foresight::FEATURES];
            let outset = Outset { x: 0.0, offset, yaw };
            let least = least_cost(&candidates);
            step_features(&candidates[candidate], least, &costs, &raster, outset, &mut features);
            features
        };
        let left = around(&[[2.0, 1.0], [3.0, 0.4]], 0.6, 0.2, 4);
        let mut mirrored = around(&[[2.0, -1.0], [3.0, -0.4]], -0.6, -0.2, CANDIDATES - 5);
        Foresight::mirror(&mut mirrored);
        // Cells are not symmetric: a place between two of them belongs to the left one.
        let differing =
            left.iter().zip(&mirrored).filter(|(one, other)| (**one - **other).abs() > 0.1).count();
        assert!(differing < 12, "{differing} of {} differ", Foresight::FEATURES);
    }
}
