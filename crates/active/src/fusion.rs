//! The belief over classes, from several views.

use opendr_engine::rig::ViewPose;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// Fusion of the evidence of views.
///
/// Views from nearby places make the same errors: two of them are hardly more than one. The correlation of two views is a
/// kernel of the way between them, `floor + (1 - floor) exp(-(d / length)^2)` with `d^2` the square of the angle (rad) and of the
/// logarithm of the ratio of distances. A view counts by one over the sum of its correlations with all views, itself
/// included, so that `n` images from one pose count as one image; a view with less information than another
/// reduces the other's weight only by the ratio of their information (`ln classes` minus entropy).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fusion {
    /// Divisor of the evidence; above 1 for an overconfident recogniser.
    pub temperature: f32,
    /// Range of the correlation.
    pub length: f32,
    /// Correlation of views from opposite sides: errors that a recogniser makes of a subject from everywhere. The sum of
    /// all weights stays below one over it.
    pub floor: f32,
}

impl Default for Fusion {
    fn default() -> Self {
        Self { temperature: 1.0, length: 0.4, floor: 0.1 }
    }
}

/// The lowest logarithm of a probability that one view can give: no single image excludes a class.
const LOWEST: f32 = -9.0;

impl Fusion {
    /// Returns the correlation of the evidence of two views, 0 to 1; of a view with itself 1.
    pub fn correlation(&self, a: &ViewPose, b: &ViewPose) -> f32 {
        let depth = if a.distance > 0.0 && b.distance > 0.0 { (a.distance / b.distance).ln() } else { 0.0 };
        let square = (a.angle_to(b).powi(2) + depth.powi(2)) as f32;
        self.floor + (1.0 - self.floor) * (-square / (self.length * self.length)).exp()
    }
}

/// Probabilities of the classes after the views so far.
#[derive(Debug, Clone)]
pub struct Belief {
    fusion: Fusion,
    classes: usize,
    poses: Vec<ViewPose>,
    /// Of each view: logarithms of probabilities, the highest 0.
    evidence: Vec<f32>,
    information: Vec<f32>,
    weights: Vec<f32>,
    probabilities: Vec<f32>,
}

/// Capacity of a new belief, in views.
const ROOM: usize = 16;

impl Belief {
    /// Creates a belief in which all classes are equally likely.
    ///
    /// # Errors
    /// `InvalidParam` for fewer than two classes and for numbers out of range.
    pub fn new(classes: usize, fusion: Fusion) -> Result<Self> {
        let Fusion { temperature, length, floor } = fusion;
        if classes < 2 || !(temperature > 0.0 && length > 0.0 && (0.0..=1.0).contains(&floor)) {
            return Err(Error::invalid_param(format!(
                "a belief over {classes} classes with {fusion:?}; give at least 2, a temperature and a length above 0 and a floor in 0..=1"
            )));
        }
        let mut belief = Self {
            fusion,
            classes,
            poses: Vec::with_capacity(ROOM),
            evidence: Vec::with_capacity(ROOM * classes),
            information: Vec::with_capacity(ROOM),
            weights: Vec::with_capacity(ROOM),
            probabilities: vec![0.0; classes],
        };
        belief.reset();
        Ok(belief)
    }

    /// Removes all views.
    pub fn reset(&mut self) {
        self.poses.clear();
        self.evidence.clear();
        self.information.clear();
        self.weights.clear();
        self.probabilities.fill(1.0 / self.classes as f32);
    }

    /// Adds a view: logarithms of the probability of each class, up to a constant.
    ///
    /// # Errors
    /// `InvalidInput` for another number of classes, for NaN, and for a pose that is not finite.
    pub fn add(&mut self, pose: ViewPose, evidence: &[f32]) -> Result<()> {
        if [pose.azimuth, pose.elevation, pose.distance].iter().any(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!("a view from {pose:?}; give a pose of finite numbers")));
        }
        let highest = evidence.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        if evidence.len() != self.classes || !highest.is_finite() || evidence.iter().any(|log| log.is_nan()) {
            return Err(Error::invalid_input(format!(
                "evidence {evidence:?} for {} classes; give one logarithm of a probability each",
                self.classes
            )));
        }
        let scale = 1.0 / self.fusion.temperature;
        self.evidence.extend(evidence.iter().map(|log| (scale * (log - highest)).max(LOWEST)));
        let own = &self.evidence[self.evidence.len() - self.classes..];
        self.information.push((self.classes as f32).ln() - entropy_of_logs(own));
        self.poses.push(pose);
        self.weigh();
        self.fuse();
        Ok(())
    }

    fn weigh(&mut self) {
        let Self { fusion, poses, information, weights, .. } = self;
        let weight = |at: usize| {
            let shared =
                poses.iter().zip(information.iter()).enumerate().map(|(other, (pose, other_information))| {
                    let share = if other == at {
                        1.0
                    } else {
                        (other_information / information[at].max(1e-6)).min(1.0)
                    };
                    share * fusion.correlation(&poses[at], pose)
                });
            1.0 / shared.sum::<f32>().max(1.0)
        };
        weights.clear();
        weights.extend((0..poses.len()).map(weight));
    }

    fn fuse(&mut self) {
        let Self { classes, evidence, weights, probabilities, .. } = self;
        probabilities.fill(0.0);
        for (weight, logs) in weights.iter().zip(evidence.chunks_exact(*classes)) {
            probabilities.iter_mut().zip(logs).for_each(|(sum, log)| *sum += weight * log);
        }
        probabilities_of_logs(probabilities);
    }

    /// Returns the probability of each class.
    pub fn probabilities(&self) -> &[f32] {
        &self.probabilities
    }

    /// Returns the most likely class and its probability; of equally likely ones the first.
    pub fn best(&self) -> (usize, f32) {
        let first = |best: (usize, f32), (class, probability): (usize, &f32)| {
            if *probability > best.1 { (class, *probability) } else { best }
        };
        self.probabilities.iter().enumerate().fold((0, 0.0), first)
    }

    /// Returns the entropy as a share of that of equally likely classes, 0 to 1.
    pub fn uncertainty(&self) -> f32 {
        let terms = self.probabilities.iter().filter(|p| **p > 0.0).map(|p| -p * p.ln());
        terms.sum::<f32>() / (self.classes as f32).ln()
    }

    /// Returns the weight of each view.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Returns the number of views.
    pub fn views(&self) -> usize {
        self.poses.len()
    }

    /// Returns the pose of the view with the most information, and its information as a share of the maximum; `None` before a view.
    pub fn most_informative(&self) -> Option<(&ViewPose, f32)> {
        let best = self.information.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        Some((&self.poses[best.0], best.1 / (self.classes as f32).ln()))
    }

    /// Returns the information of the last view as a share of the maximum, 0 before a view.
    pub fn last_information(&self) -> f32 {
        self.information.last().map_or(0.0, |information| information / (self.classes as f32).ln())
    }

    /// Returns the number of classes.
    pub fn classes(&self) -> usize {
        self.classes
    }
}

/// Replaces logarithms of probabilities, up to a constant, by the probabilities, whose sum is 1.
pub(crate) fn probabilities_of_logs(logs: &mut [f32]) {
    let highest = logs.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    logs.iter_mut().for_each(|log| *log = (*log - highest).exp());
    let sum: f32 = logs.iter().sum();
    logs.iter_mut().for_each(|probability| *probability /= sum);
}

/// Logarithm of the sum of exponentials, without overflow.
pub(crate) fn log_sum(logs: impl Iterator<Item = f32> + Clone) -> f32 {
    let highest = logs.clone().fold(f32::NEG_INFINITY, f32::max);
    highest + logs.map(|log| (log - highest).exp()).sum::<f32>().ln()
}

/// Entropy in nats of logarithms of probabilities up to a constant, the highest of which is 0.
fn entropy_of_logs(logs: &[f32]) -> f32 {
    let sum: f32 = logs.iter().map(|log| log.exp()).sum();
    sum.ln() - logs.iter().map(|log| log.exp() * log).sum::<f32>() / sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(azimuth: f64) -> ViewPose {
        ViewPose { azimuth, distance: 3.0, ..ViewPose::default() }
    }

    fn fused(views: &[(f64, [f32; 3])], fusion: Fusion) -> Belief {
        let mut belief = Belief::new(3, fusion).unwrap();
        for (azimuth, probabilities) in views {
            belief.add(at(*azimuth), &probabilities.map(f32::ln)).unwrap();
        }
        belief
    }

    const SURE: [f32; 3] = [0.6, 0.3, 0.1];
    const EVEN: [f32; 3] = [1.0 / 3.0; 3];

    #[test]
    fn pictures_from_one_place_count_once() {
        let one = fused(&[(0.0, SURE)], Fusion::default());
        let seven = fused(&[(0.0, SURE); 7], Fusion::default());
        assert!((one.best().1 - 0.6).abs() < 1e-6);
        assert!((seven.best().1 - one.best().1).abs() < 1e-5, "{seven:?}");
    }

    #[test]
    fn views_from_apart_count_more_and_stay_below_the_cap() {
        let views: Vec<_> = (0..6).map(|at| (f64::from(at), SURE)).collect();
        let (few, many) = (fused(&views[..2], Fusion::default()), fused(&views, Fusion::default()));
        assert!(0.6 < few.best().1 && few.best().1 < many.best().1);
        let fusion = Fusion { floor: 0.5, ..Fusion::default() };
        assert!(fused(&views, fusion).weights().iter().sum::<f32>() < 2.0);
        let free = Fusion { floor: 0.0, length: 0.01, ..fusion };
        assert!(fused(&views, free).weights().iter().all(|weight| *weight > 0.999));
    }

    #[test]
    fn a_view_that_says_nothing_changes_nothing() {
        let fusion = Fusion { floor: 0.5, ..Fusion::default() };
        let alone = fused(&[(0.0, SURE)], fusion);
        for azimuth in [0.0, 0.3, 3.0] {
            let with = fused(&[(azimuth, EVEN), (0.0, SURE), (azimuth, EVEN)], fusion);
            assert!((alone.best().1 - with.best().1).abs() < 1e-4, "{with:?}");
        }
        assert!(fused(&[(0.0, EVEN)], fusion).uncertainty() > 0.999);
    }

    #[test]
    fn order_does_not_matter() {
        let views = [(0.0, SURE), (0.4, [0.2, 0.7, 0.1]), (2.0, [0.1, 0.1, 0.8])];
        let mut turned = views;
        turned.reverse();
        let [a, b] = [views, turned].map(|views| fused(&views, Fusion::default()));
        let pairs = a.probabilities().iter().zip(b.probabilities());
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
    }

    #[test]
    fn what_is_no_evidence_is_refused() {
        assert!(Belief::new(1, Fusion::default()).is_err());
        assert!(Belief::new(3, Fusion { temperature: 0.0, ..Fusion::default() }).is_err());
        let mut belief = Belief::new(3, Fusion::default()).unwrap();
        for evidence in [&[0.0; 2][..], &[0.0, f32::NAN, 0.0], &[f32::NEG_INFINITY; 3]] {
            assert!(belief.add(at(0.0), evidence).is_err());
        }
        assert!(belief.add(at(f64::NAN), &[0.0; 3]).is_err());
        assert!(belief.add(ViewPose { distance: f64::INFINITY, ..at(0.0) }, &[0.0; 3]).is_err());
        assert_eq!((belief.views(), belief.best().1), (0, 1.0 / 3.0));
    }
}
