//! COCO's average precision of keypoints.

use opendr_engine::Result;
use opendr_engine::params::Params;
use opendr_engine::target::{Pose, PoseList, Skeleton};

use super::accumulator::Accumulator;
use super::decimal::{f64_box, f64_from_f32};
use super::detection::{checked_score, image_index, truth_of};
use super::list_accumulator::quality_without_objects;
use super::matching::{Detection, GroundTruth};
use super::overlap::{JOINTS, Person, check_box, keypoint_similarity};
use super::protocol::Protocol;
use crate::{Metric, Report};

/// Parameters of [`CocoKeypoints`].
#[derive(Debug, Clone, Params)]
pub struct CocoKeypointsParams {
    /// Maximum number of persons per image; those with the highest scores count.
    #[param(default = 20, range = 1..=100_000)]
    pub max_detections: u32,
}

/// Average precision and recall of persons by their keypoints: pycocotools' `COCOeval(.., "keypoints")`.
///
/// Poses of any skeleton are compared by the names of COCO's 17 joints. A joint that is missing in the ground truth was
/// not annotated; one that is missing in a prediction is at (0, 0), as in COCO's result files. Box, area and crowd flag
/// of the ground truth are those of [`Pose::region`], otherwise those of the box around its joints.
#[derive(Debug, Clone)]
pub struct CocoKeypoints {
    accumulator: Accumulator<()>,
}

impl Metric for CocoKeypoints {
    const NAME: &'static str = "coco_keypoints";
    const ABOUT: &'static str = "average precision and recall of persons by their keypoints, as pycocotools";
    const NUMBERS: &'static [(&'static str, &'static str)] = super::summary::NUMBERS;
    const IS_RANKING: bool = true;
    type Params = CocoKeypointsParams;
    type Prediction = PoseList;
    type GroundTruth = PoseList;

    fn new(params: &CocoKeypointsParams) -> Result<Self> {
        Ok(Self { accumulator: Accumulator::new(Protocol::keypoints(params.max_detections)) })
    }

    fn update(&mut self, at: usize, prediction: &PoseList, ground_truth: &PoseList) -> Result<f64> {
        let predicted = prediction.poses.iter().map(detection).collect::<Result<Vec<_>>>()?;
        let (detections, detected): (Vec<Detection>, Vec<_>) = predicted.into_iter().unzip();
        let annotated = ground_truth.poses.iter().map(person).collect::<Result<Vec<_>>>()?;
        let (ground_truths, persons): (Vec<GroundTruth>, Vec<Person>) = annotated.into_iter().unzip();
        let similarity = |detection: usize, ground_truth: usize| {
            Ok(keypoint_similarity(&detected[detection], &persons[ground_truth]))
        };
        let quality = self.accumulator.add(&(), image_index(at)?, &ground_truths, &detections, similarity)?;
        Ok(quality.unwrap_or_else(|| quality_without_objects(&detections)))
    }

    fn merge(&mut self, other: Self) {
        self.accumulator.merge(other.accumulator);
    }

    fn finish(&self) -> Report {
        self.accumulator.finish(1).report(|()| "person".to_owned())
    }
}

/// Returns the positions of COCO's joints, (0, 0) for missing ones, and whether each was detected.
fn joints(pose: &Pose) -> ([[f64; 2]; JOINTS], [bool; JOINTS]) {
    let (mut positions, mut is_detected) = ([[0.0; 2]; JOINTS], [false; JOINTS]);
    for (at, name) in Skeleton::Coco17.joints().iter().enumerate().take(JOINTS) {
        if let Some(keypoint) = pose.keypoint(name).filter(|keypoint| keypoint.is_detected()) {
            positions[at] = [keypoint.x, keypoint.y].map(f64_from_f32);
            is_detected[at] = true;
        }
    }
    (positions, is_detected)
}

fn detection(pose: &Pose) -> Result<(Detection, [[f64; 2]; JOINTS])> {
    let (positions, _) = joints(pose);
    Ok((Detection { score: checked_score(pose.confidence)?, area: area_around(&positions) }, positions))
}

/// Returns the area of the box around all joints, including those at (0, 0).
pub(super) fn area_around(joints: &[[f64; 2]; JOINTS]) -> f64 {
    let extent = |axis: usize| {
        let along = joints.iter().map(|joint| joint[axis]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    extent(0) * extent(1)
}

fn person(pose: &Pose) -> Result<(GroundTruth, Person)> {
    let (positions, is_detected) = joints(pose);
    let around = pose.bounding_box().unwrap_or_default().map(f64_from_f32);
    let region = pose.region.as_deref();
    let bounding_box = region.map_or(around, f64_box);
    check_box(bounding_box, "person")?;
    let box_area = bounding_box[2] * bounding_box[3];
    let plain = GroundTruth { area: box_area, crowd: false, ignored: false };
    let mut ground_truth = region.map_or(plain, |region| truth_of(region, box_area));
    ground_truth.ignored |= is_detected == [false; JOINTS];
    let joints =
        std::array::from_fn(|at| [positions[at][0], positions[at][1], f64::from(u8::from(is_detected[at]))]);
    Ok((ground_truth, Person { joints, bounding_box, area: ground_truth.area }))
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::Keypoint;

    use super::*;

    fn pose(skeleton: Skeleton) -> Pose {
        let place = |name: &&str| match Skeleton::Coco17.joint(name) {
            Some(at) => Keypoint { x: 10.0 * at as f32, y: 7.0 * (at % 5) as f32, confidence: 1.0 },
            None => Keypoint::MISSING,
        };
        let keypoints = skeleton.joints().iter().map(place).collect();
        Pose { keypoints, skeleton, confidence: 0.9, ..Pose::default() }
    }

    #[test]
    fn joints_of_other_skeletons_match_by_name() {
        let mut metric = CocoKeypoints::new(&CocoKeypointsParams::default()).unwrap();
        let [prediction, ground_truth] =
            [Skeleton::Opendr18, Skeleton::Coco17].map(|skeleton| vec![pose(skeleton)].into());
        assert!((metric.update(0, &prediction, &ground_truth).unwrap() - 1.0).abs() < 1e-9);
        // A person without annotated joints is ignored.
        let mut unannotated = pose(Skeleton::Coco17);
        unannotated.keypoints.iter_mut().for_each(|keypoint| *keypoint = Keypoint::MISSING);
        assert!(
            (metric.update(1, &Vec::new().into(), &vec![unannotated].into()).unwrap() - 1.0).abs() < 1e-9
        );
        assert!((metric.finish().statistics.get("mar").unwrap() - 1.0).abs() < 1e-9);
    }
}
