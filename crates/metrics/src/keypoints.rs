//! Keypoints: percentage of correct keypoints (PCK, PCKh) and its area, normalised mean error (NME), end-point error
//! (EPE), equal to MMPose.

mod matching;
mod params;
mod places;
mod size;

use opendr_engine::target::{Pose, PoseList};
use opendr_engine::{Error, Result};

pub use params::{KeypointsParams, PoseSize};

use places::{place_of, places_like};

use crate::average::{mean, ratio};
use crate::{Curves, Figure, Line, Metric, Report, Table};

/// Maximum number of joints of a pose.
const MAX_JOINTS: usize = 4096;

/// Number of thresholds of the area under the curve: 0, 0.05 to 0.95, as in MMPose.
const STEPS: usize = 20;

/// Counts of one joint.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Joint {
    /// Number of poses in which it is annotated.
    count: u64,
    correct: u64,
    within: [u64; STEPS],
    /// Number of annotated poses in which it is predicted.
    found: u64,
    /// Sum of the distances in these, in pixels.
    distance: f64,
    /// Sum of the normalised distances.
    normalized: f64,
}

/// Accumulates joints over poses; memory is bounded.
#[derive(Debug, Clone, Default)]
pub struct Keypoints {
    params: KeypointsParams,
    joints: Vec<Joint>,
    names: &'static [&'static str],
    poses: u64,
    /// Number of poses without a size, which are ignored.
    without_size: u64,
}

impl Keypoints {
    /// Adds a pose of `size` pixels and returns its fraction of correct joints; `None` if no joint is annotated. Joints that
    /// are not annotated are `None` in `ground_truth`. Joints that are not predicted are `None` in `predicted`; they are incorrect
    /// and have no distance.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the numbers of joints differ or are above 4096, a coordinate is NaN or infinite, or the size
    /// is not a positive number.
    pub fn add(
        &mut self,
        ground_truth: &[Option<[f64; 2]>],
        predicted: &[Option<[f64; 2]>],
        size: f64,
    ) -> Result<Option<f64>> {
        if ground_truth.len() != predicted.len() || ground_truth.len() > MAX_JOINTS {
            let (expected, given) = (ground_truth.len(), predicted.len());
            return Err(Error::invalid_input(format!(
                "a pose of {given} joints cannot be compared with one of {expected}; give poses of the same joints, at most {MAX_JOINTS}"
            )));
        }
        let places = ground_truth.iter().chain(predicted).flatten().flatten();
        if let Some(place) = places.into_iter().chain([&size]).find(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "a coordinate or size of a pose is {place}; give finite numbers"
            )));
        }
        if size <= 0.0 {
            return Err(Error::invalid_input(format!(
                "the size of a pose is {size}; give a positive number"
            )));
        }
        if self.joints.len() < ground_truth.len() {
            self.joints.resize(ground_truth.len(), Joint::default());
        }
        self.poses += 1;
        let (mut count, mut correct) = (0, 0);
        for (joint, (ground_truth, predicted)) in
            self.joints.iter_mut().zip(ground_truth.iter().zip(predicted))
        {
            let Some(ground_truth) = ground_truth else { continue };
            joint.count += 1;
            count += 1;
            let Some(predicted) = predicted else { continue };
            let distance = (predicted[0] - ground_truth[0]).hypot(predicted[1] - ground_truth[1]);
            joint.found += 1;
            joint.distance += distance;
            joint.normalized += distance / size;
            let is_correct = self.params.is_correct(distance / size);
            joint.correct += u64::from(is_correct);
            correct += u64::from(is_correct);
            for (step, within) in joint.within.iter_mut().enumerate() {
                *within += u64::from(distance / size < step as f64 / STEPS as f64);
            }
        }
        Ok(ratio(correct, count))
    }

    /// Returns the fraction of correct joints: the mean over joints that are annotated at least once.
    pub fn pck(&self) -> Option<f64> {
        mean(self.joints.iter().filter_map(|joint| ratio(joint.correct, joint.count)))
    }

    /// Returns the fraction of correct joints over all annotated joints, as in the MPII benchmark (PCKh).
    pub fn pooled_pck(&self) -> Option<f64> {
        ratio(self.total(|joint| joint.correct), self.total(|joint| joint.count))
    }

    /// Returns [`Keypoints::pck`] at each threshold of the area under the curve.
    fn curve(&self) -> [Option<f64>; STEPS] {
        std::array::from_fn(|at| {
            mean(self.joints.iter().filter_map(|joint| ratio(joint.within[at], joint.count)))
        })
    }

    /// Returns the mean of [`Keypoints::pck`] at the thresholds 0, 0.05 to 0.95.
    pub fn area(&self) -> Option<f64> {
        mean(self.curve().into_iter().flatten())
    }

    /// Returns the mean normalised distance of the predicted joints.
    pub fn normalized_mean_error(&self) -> Option<f64> {
        self.mean_of_found(|joint| joint.normalized)
    }

    /// Returns the mean distance of the predicted joints, in pixels.
    pub fn end_point_error(&self) -> Option<f64> {
        self.mean_of_found(|joint| joint.distance)
    }

    fn mean_of_found(&self, sum: fn(&Joint) -> f64) -> Option<f64> {
        let found = self.total(|joint| joint.found);
        (found > 0).then(|| self.joints.iter().map(sum).sum::<f64>() / found as f64)
    }

    fn total(&self, number: fn(&Joint) -> u64) -> u64 {
        self.joints.iter().map(number).sum()
    }

    fn add_pose(&mut self, ground_truth: &Pose, predicted: Option<&Pose>, size: f64) -> Result<Option<f64>> {
        let places = ground_truth.keypoints.iter().map(place_of).collect::<Vec<_>>();
        let predicted =
            predicted.map_or_else(|| vec![None; places.len()], |pose| places_like(ground_truth, pose));
        self.add(&places, &predicted, size)
    }

    fn table(&self) -> Table {
        let row = |(at, joint): (usize, &Joint)| {
            let found = |sum: f64| (joint.found > 0).then(|| sum / joint.found as f64);
            let name = self.names.get(at).map_or_else(|| at.to_string(), |name| (*name).to_owned());
            let pck = ratio(joint.correct, joint.count);
            (name, vec![pck, found(joint.normalized), found(joint.distance), Some(joint.count as f64)])
        };
        Table {
            name: "joint".to_owned(),
            columns: ["pck", "nme", "epe", "count"].map(str::to_owned).into(),
            rows: self.joints.iter().enumerate().map(row).collect(),
        }
    }
}

/// Each ground-truth pose is matched with the nearest unmatched prediction; other predictions are ignored. Poses of
/// different skeletons are compared by the names of the ground-truth joints.
impl Metric for Keypoints {
    const NAME: &'static str = "keypoints";
    const ABOUT: &'static str = "PCK, PCKh and their area, NME and EPE of keypoints, as MMPose";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("pck", "Fraction of joints within the threshold, mean over joints."),
        ("pck_pooled", "Fraction over all joints together."),
        ("auc", "Area under the curve of PCK over the threshold."),
        ("nme", "Mean distance, normalised by the size of the pose."),
        ("epe", "Mean distance in pixels."),
        ("poses", "Number of poses."),
        ("poses_without_size", "Number of poses without a size to normalise by."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &["nme", "epe"];
    type Params = KeypointsParams;
    type Prediction = PoseList;
    type GroundTruth = PoseList;

    fn new(params: &KeypointsParams) -> Result<Self> {
        if params.normalize == PoseSize::Joints
            && (params.joints.is_empty() || !params.joints.len().is_multiple_of(2))
        {
            return Err(Error::invalid_param(format!(
                "joints = {:?}: give an even number of joints to normalise by",
                params.joints
            )));
        }
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn update(&mut self, _at: usize, prediction: &PoseList, ground_truth: &PoseList) -> Result<f64> {
        let mut image = Self { params: self.params.clone(), ..Self::default() };
        let sizes: Vec<Option<f64>> =
            ground_truth.poses.iter().map(|pose| self.params.size_of_pose(pose)).collect();
        let matches = matching::nearest(&ground_truth.poses, &prediction.poses)?;
        for ((pose, size), matched) in ground_truth.poses.iter().zip(sizes).zip(matches) {
            let matched = matched.and_then(|at| prediction.poses.get(at));
            match size {
                Some(size) => image.add_pose(pose, matched, size)?,
                None => {
                    image.without_size += 1;
                    None
                }
            };
            if pose.skeleton.joints().len() == pose.keypoints.len() {
                image.names = pose.skeleton.joints();
            }
        }
        let score = image.pooled_pck().unwrap_or(1.0);
        self.merge(image);
        Ok(score)
    }

    fn merge(&mut self, other: Self) {
        if self.joints.len() < other.joints.len() {
            self.joints.resize(other.joints.len(), Joint::default());
        }
        for (joint, more) in self.joints.iter_mut().zip(&other.joints) {
            joint.count += more.count;
            joint.correct += more.correct;
            joint.found += more.found;
            joint.distance += more.distance;
            joint.normalized += more.normalized;
            joint.within.iter_mut().zip(more.within).for_each(|(mine, more)| *mine += more);
        }
        if self.names.len() < other.names.len() {
            self.names = other.names;
        }
        self.poses += other.poses;
        self.without_size += other.without_size;
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("pck");
        let numbers = [
            ("poses", Some(self.poses as f64)),
            ("poses_without_size", Some(self.without_size as f64)),
            ("pck", self.pck()),
            ("pck_pooled", self.pooled_pck()),
            ("auc", self.area()),
            ("nme", self.normalized_mean_error()),
            ("epe", self.end_point_error()),
        ];
        for (key, value) in numbers {
            report.statistics.set(key, value.unwrap_or(f64::NAN));
        }
        report.tables.push(self.table());
        let points = self.curve().into_iter().enumerate();
        let points =
            points.filter_map(|(at, pck)| Some([at as f64 / STEPS as f64, pck?])).collect::<Vec<_>>();
        if !points.is_empty() {
            report.figures.push(Figure::Curves(Curves {
                name: "pck".to_owned(),
                title: "Fraction of correct keypoints".to_owned(),
                x: "threshold, normalised by the size of the pose".to_owned(),
                y: "PCK".to_owned(),
                lines: vec![Line { label: "all joints".to_owned(), points }],
            }));
        }
        report
    }
}

#[cfg(test)]
mod tests;
