//! The direction to the best view, from several views.

use opendr_engine::rig::ViewPose;

use super::estimator::BestViewEstimate;
use crate::fusion::{Fusion, probabilities_of_logs};

/// Number of directions.
const DIRECTIONS: usize = 300;
/// Capacity of a new belief, in views.
const ROOM: usize = 16;
/// Cosine of the radius around the most likely direction whose probability is its certainty: 30 degrees.
const AROUND: f32 = 0.866;
/// Share of a view's estimate that is equal in all directions: no single image excludes one.
const UNKNOWN: f32 = 0.02;

/// Probabilities of directions to the best view after the views so far.
///
/// The directions are the points of a Fibonacci lattice, 12 degrees apart. The estimates of views are multiplied; a view counts by one
/// over the sum of its correlations with all views ([`Fusion::correlation`] with its default range), so that several images from one
/// pose count as one.
#[derive(Debug, Clone)]
pub struct BestViewBelief {
    directions: Vec<[f32; 3]>,
    poses: Vec<ViewPose>,
    /// Of each view: logarithm of the density of each direction.
    densities: Vec<f32>,
    probabilities: Vec<f32>,
}

/// The direction to the best view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestView {
    /// Most likely direction, of length 1, in the rig's frame: the mean of the directions within 30 degrees of the most likely one.
    pub direction: [f32; 3],
    /// Probability of the directions within 30 degrees of it.
    pub certainty: f32,
    /// Mean of all directions, whose length is below 1 for a wide distribution.
    pub mean: [f32; 3],
}

impl Default for BestViewBelief {
    fn default() -> Self {
        let golden = std::f32::consts::PI * (3.0 - 5f32.sqrt());
        let direction = |at: usize| {
            let z = 1.0 - (2.0 * at as f32 + 1.0) / DIRECTIONS as f32;
            let (level, (sine, cosine)) = ((1.0 - z * z).sqrt(), (golden * at as f32).sin_cos());
            [level * cosine, level * sine, z]
        };
        let mut belief = Self {
            directions: (0..DIRECTIONS).map(direction).collect(),
            poses: Vec::with_capacity(ROOM),
            densities: Vec::with_capacity(ROOM * DIRECTIONS),
            probabilities: vec![0.0; DIRECTIONS],
        };
        belief.reset();
        belief
    }
}

impl BestViewBelief {
    /// Removes all views.
    pub fn reset(&mut self) {
        self.poses.clear();
        self.densities.clear();
        self.probabilities.fill(1.0 / DIRECTIONS as f32);
    }

    /// Adds the estimate of a view from a pose, in the frame of its camera.
    pub fn add(&mut self, pose: ViewPose, estimate: &BestViewEstimate) {
        let Self { directions, poses, densities, probabilities } = self;
        let estimate = estimate.in_rig_frame(&pose);
        poses.push(pose);
        densities.extend(directions.iter().map(|direction| {
            let density = estimate.density(*direction);
            ((1.0 - UNKNOWN) * density + UNKNOWN / (4.0 * std::f32::consts::PI)).ln()
        }));
        let fusion = Fusion::default();
        probabilities.fill(0.0);
        for (pose, view) in poses.iter().zip(densities.chunks_exact(DIRECTIONS)) {
            let shared: f32 = poses.iter().map(|other| fusion.correlation(pose, other)).sum();
            let weight = 1.0 / shared.max(1.0);
            probabilities.iter_mut().zip(view).for_each(|(sum, log)| *sum += weight * log);
        }
        probabilities_of_logs(probabilities);
    }

    /// Returns the most likely direction; before a view its certainty is that of any.
    pub fn best(&self) -> BestView {
        let all = || self.directions.iter().zip(&self.probabilities);
        let likeliest =
            all().max_by(|a, b| a.1.total_cmp(b.1)).map_or([1.0, 0.0, 0.0], |(likeliest, _)| *likeliest);
        let (mut near, mut mean, mut certainty) = ([0.0; 3], [0.0; 3], 0.0);
        for (direction, probability) in all() {
            let add = |sum: &mut [f32; 3]| {
                sum.iter_mut().zip(direction).for_each(|(sum, part)| *sum += probability * part);
            };
            add(&mut mean);
            if product(*direction, likeliest) >= AROUND {
                add(&mut near);
                certainty += probability;
            }
        }
        let length = product(near, near).sqrt().max(1e-12);
        BestView { direction: near.map(|part| part / length), certainty, mean }
    }
}

fn product(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
