//! The temperature and the correlation of views, from recorded episodes.

use opendr_engine::rig::ViewPose;
use opendr_engine::{Error, Result};

use crate::fusion::{Belief, Fusion};

/// The views of an episode, with the true class.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// The true class.
    pub class: usize,
    /// Poses of the views, in their order.
    pub poses: Vec<ViewPose>,
    /// Evidence of each view, one after the other, as the recogniser returned it.
    pub evidence: Vec<f32>,
}

/// Values tried for the temperature are these factors apart.
const FACTOR: f32 = 1.2;
const LENGTHS: [f32; 4] = [0.1, 0.3, 0.6, 1.2];
const FLOORS: [f32; 5] = [0.0, 0.1, 0.25, 0.45, 0.75];

/// Returns the fusion with the lowest mean negative log-likelihood of the true classes over the beliefs after each view, with
/// half of the weight on the last one.
///
/// # Errors
/// Returns `InvalidInput` without trajectories, and for evidence of another number of classes.
pub fn fit_fusion(classes: usize, trajectories: &[Trajectory]) -> Result<Fusion> {
    if trajectories.is_empty() {
        return Err(Error::invalid_input("no episodes to calibrate on; record at least a hundred"));
    }
    let mut best = (f64::INFINITY, Fusion::default());
    for length in LENGTHS {
        for floor in FLOORS {
            // The loss has one minimum over the temperature: walk down from what was best so far.
            let mut here = Fusion { length, floor, ..best.1 };
            let mut loss = negative_log_likelihood(classes, trajectories, here)?;
            for factor in [FACTOR, 1.0 / FACTOR] {
                loop {
                    let next = Fusion { temperature: here.temperature * factor, ..here };
                    let lower = negative_log_likelihood(classes, trajectories, next)?;
                    if lower >= loss || !(0.02..50.0).contains(&next.temperature) {
                        break;
                    }
                    (loss, here) = (lower, next);
                }
            }
            if loss < best.0 {
                best = (loss, here);
            }
        }
    }
    Ok(best.1)
}

/// Returns the mean loss of trajectories that [`fit_fusion`] minimises.
///
/// # Errors
/// As [`fit_fusion`].
pub fn negative_log_likelihood(classes: usize, trajectories: &[Trajectory], fusion: Fusion) -> Result<f64> {
    let mut belief = Belief::new(classes, fusion)?;
    let mut sum = 0.0;
    for Trajectory { class, poses, evidence } in trajectories {
        belief.reset();
        let (mut losses, mut last) = (0.0, 0.0);
        for (pose, logs) in poses.iter().zip(evidence.chunks_exact(classes)) {
            belief.add(*pose, logs)?;
            let probability = belief.probabilities().get(*class).copied().unwrap_or(0.0);
            last = -f64::from(probability.max(1e-9)).ln();
            losses += last;
        }
        sum += 0.5 * (losses / poses.len().max(1) as f64 + last);
    }
    Ok(sum / trajectories.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;

    use super::*;

    /// Views whose evidence is three times too confident, and equal from equal poses.
    fn trajectories() -> Vec<Trajectory> {
        let mut random = Random::new(1);
        let mut trajectory = || {
            let class = random.below(4);
            let mut poses = Vec::new();
            let mut evidence: Vec<f32> = Vec::new();
            for view in 0..4 {
                let azimuth = f64::from(view / 2) * 1.5;
                poses.push(ViewPose { azimuth, distance: 1.0, ..ViewPose::default() });
                if view % 2 == 1 {
                    let same = evidence[evidence.len() - 4..].to_vec();
                    evidence.extend(same);
                } else {
                    // The likelihood of a normal measurement of each class with deviation 1 and mean 1 for the true one.
                    let measured = (0..4).map(|at| random.normal() as f32 + f32::from(at == class));
                    evidence.extend(measured.map(|value| 3.0 * value));
                }
            }
            Trajectory { class, poses, evidence }
        };
        (0..2000).map(|_| trajectory()).collect()
    }

    #[test]
    fn certainty_and_correlation_are_found() {
        let trajectories = trajectories();
        let fusion = fit_fusion(4, &trajectories).unwrap();
        assert!((2.5..3.6).contains(&fusion.temperature), "{fusion:?}");
        assert!(fusion.floor <= 0.1 && fusion.length < 1.4, "{fusion:?}");
        let loss = |fusion| negative_log_likelihood(4, &trajectories, fusion).unwrap();
        assert!(loss(fusion) < loss(Fusion { temperature: 1.0, ..fusion }) - 0.1, "{fusion:?}");
        assert!(fit_fusion(4, &[]).is_err());
    }
}
