//! MoveNet: fast keypoints of one person (Lightning) or of up to six (MultiPose).
//!
//! Votel and Li, Google, 2021, Apache-2.0. Lightning expects a person who fills the image: crop the image, or use
//! MultiPose.

use std::array;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Keypoint, Pose, PoseList};
use opendr_engine::{Device, Error, Result, Task};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::{InputGeometry, LetterboxAlign, Preprocess};

use crate::pose_estimation::opendr_from_coco;

/// Parameters of [`Movenet`].
#[derive(Debug, Clone, Params)]
pub struct MovenetParams {
    /// Score below which persons are dropped.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which joints are missing.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Longer side of the input of MultiPose; a multiple of 32. Larger values detect smaller persons.
    #[param(default = 256, range = 128..=1024, unit = "px")]
    pub size: usize,
}

/// A loaded MoveNet.
pub struct Movenet {
    params: MovenetParams,
    network: ImageNetwork,
    heads: Heads,
    side: usize,
}

/// Layout of the network's output.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Heads {
    /// One person, `[1, 1, 17, 3]`: y, x, score.
    One,
    /// Six persons, `[1, 6, 56]`: 17 times y, x, score; then the box and the score of the person.
    Six,
}

/// Number of values per person.
const ONE: usize = 17 * 3;
const SIX: usize = ONE + 5;

impl Learner for Movenet {
    const SPEC: Spec = Spec::new("movenet", Task::PoseEstimation)
        .class("MovenetLearner")
        .about("MoveNet detects 18 joints of one person (lightning) or of up to six (multipose).");
    type Params = MovenetParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = ();

    fn load(model: &Model, mut params: MovenetParams, device: Device) -> Result<Self> {
        let mut side = params.size.next_multiple_of(32);
        let network = ImageNetwork::open(model, device, |input| {
            side = input.dims.get(2).copied().flatten().unwrap_or(side);
            Preprocess::new(side, side).letterbox(LetterboxAlign::Centre, 0.0)
        })?;
        params.size = side;
        let last = network.outputs().first().and_then(|output| *output.dims.last()?);
        let heads = match last {
            Some(3) => Heads::One,
            Some(SIX) => Heads::Six,
            last => {
                return Err(Error::format(format!(
                    "the output of a MoveNet needs rows of 3 or {SIX} values, not {last:?}; load another model"
                )));
            }
        };
        Ok(Self { params, network, heads, side })
    }

    fn params(&self) -> &MovenetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut MovenetParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), image: &Image, poses: &mut PoseList) -> Result<()> {
        self.find_with(&self.params, image, poses)
    }
}

impl Movenet {
    /// As [`Learner::infer_into`], with other thresholds than the learner's own.
    pub(crate) fn find_with(
        &self,
        params: &MovenetParams,
        image: &Image,
        poses: &mut PoseList,
    ) -> Result<()> {
        poses.poses.clear();
        self.network.run(image, |outputs, geometry| {
            let row = if self.heads == Heads::One { ONE } else { SIX };
            let rows = outputs[0].values::<f32>()?.chunks_exact(row);
            poses.poses.extend(rows.filter_map(|row| self.pose(params, row, geometry)));
            Ok(())
        })?;
        poses.poses.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        Ok(())
    }

    fn pose(&self, params: &MovenetParams, row: &[f32], geometry: &InputGeometry) -> Option<Pose> {
        let side = self.side as f32;
        let joints: [Keypoint; 17] = array::from_fn(|joint| {
            let [y, x, confidence] = array::from_fn(|at| row[3 * joint + at]);
            let [x, y] = geometry.image_from_input([x * side, y * side]);
            Keypoint { x, y, confidence }
        });
        let confidence = match self.heads {
            Heads::One => joints.iter().map(|joint| joint.confidence).sum::<f32>() / 17.0,
            Heads::Six => row[SIX - 1],
        };
        if confidence.is_nan() || confidence < params.threshold {
            return None;
        }
        let mut pose = Pose { confidence, ..Pose::default() };
        opendr_from_coco(&mut pose, &joints, params.keypoint_threshold);
        Some(pose)
    }
}
