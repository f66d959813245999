//! High-resolution pose estimation: a coarse pass over the whole image, then a second pass over selected regions.
//!
//! After OpenDR's learner of this name (Manousis et al., "Enabling High-Resolution Pose Estimation in Real Time Using
//! Active Perception", ICIP 2023), with the network of Lightweight OpenPose. Persons of 40 pixels in a 4K image do not
//! appear in the coarse heatmaps. Regions are therefore also selected where the image has detail, and where persons were
//! in the last frame. Regions that exceed the budget of one frame are processed in the next ones, in turn; until then their
//! persons keep their last poses.

mod params;
mod search;
#[cfg(test)]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Pose, PoseList};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::regions::Region;

pub use self::params::{HighResolutionPoseEstimationParams, RegionMethod};
use self::search::{Look, Search};
use crate::pose_estimation::lightweight_open_pose::{LightweightOpenPose, LightweightOpenPoseParams};
use crate::pose_estimation::pose_tracks::PoseTracks;

/// A loaded network with the selection of regions.
pub struct HighResolutionPoseEstimation {
    params: HighResolutionPoseEstimationParams,
    network: LightweightOpenPose,
    search: Search,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    looks: Vec<Look>,
    found: Vec<Pose>,
}

/// State of a stream: its persons, their regions, and the positions in the rotations.
#[derive(Default)]
pub struct HighResolutionPoseEstimationState {
    size: [usize; 2],
    tracks: PoseTracks,
    persons: Vec<Region>,
    /// Positions in the rotations of known persons and of other regions.
    turns: [usize; 2],
    /// Persons of the second pass, with their last poses.
    held: Vec<Held>,
    before: Vec<Held>,
}

struct Held {
    pose: Pose,
    /// Frames since then.
    age: u32,
}

/// Number of frames for which a person is kept without a second pass.
const MOST_HELD: u32 = 10;
/// Mean distance of joints, as a share of the smaller person's extent, below which two poses are one person.
const SAME_PERSON: f32 = 0.25;

impl Learner for HighResolutionPoseEstimation {
    const SPEC: Spec = Spec::new("high_resolution_pose_estimation", Task::PoseEstimation)
        .class("HighResolutionPoseEstimationLearner")
        .about("Pose estimation in large images in two passes: coarse, then finer where persons may be.")
        .without_effect(&[
            ("base_height", "`first_pass_height` and `second_pass_height` set it"),
            ("mobilenet_use_stride", "the maps have a stride of 8 pixels"),
            ("shufflenet_groups", "the backbone is MobileNet"),
            ("experiment_name", "it does not train: `lightweight_open_pose` does"),
            ("weights_only", "it does not train: `lightweight_open_pose` does"),
            ("output_name", "`eval` writes predictions"),
            ("multiscale", "regions are magnified in the second pass"),
            ("scales", "regions are magnified in the second pass"),
            ("visualize", "`draw` draws poses"),
            ("img_mean", "the model defines it"),
            ("img_scale", "the model defines it"),
            ("pad_value", "the model defines it"),
            ("half_precision", "the runtime chooses the precision"),
        ]);
    type Params = HighResolutionPoseEstimationParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = HighResolutionPoseEstimationState;

    fn load(model: &Model, params: HighResolutionPoseEstimationParams, device: Device) -> Result<Self> {
        let network = LightweightOpenPose::load(model, network_params(&params), device)?;
        Ok(Self { params, network, search: Search::default(), scratch: Pool::default() })
    }

    fn params(&self) -> &HighResolutionPoseEstimationParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut HighResolutionPoseEstimationParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut HighResolutionPoseEstimationState,
        image: &Image,
        poses: &mut PoseList,
    ) -> Result<()> {
        let Scratch { looks, found } = &mut *self.scratch.take();
        let params = &self.params;
        let settings = network_params(params);
        let size = [image.width(), image.height()];
        if state.size != size || !params.track {
            *state = HighResolutionPoseEstimationState { size, ..Default::default() };
        }
        let view = image.view();
        poses.poses.clear();
        self.search.begin(params, view, looks, |grid| {
            self.network.find_with(&settings, view, params.first_pass_height, &mut poses.poses, |maps| {
                let input = maps.grid();
                grid.reset(input.columns, input.rows);
                grid.mark(|column, row| maps.max_heat(column, row) > params.heatmap_threshold);
            })
        })?;
        let is_all = self.search.choose(params, size, &state.persons, &mut state.turns, looks);
        let seen = poses.poses.len();
        for look in looks.iter() {
            let Region { x, y, width, height } = look.region;
            let Some(part) = view.crop(x, y, width, height) else { continue };
            found.clear();
            self.network.find_with(&settings, part, look.height, found, |_| {})?;
            for mut pose in found.drain(..) {
                for joint in pose.keypoints.iter_mut().filter(|joint| joint.is_detected()) {
                    (joint.x, joint.y) = (joint.x + x as f32, joint.y + y as f32);
                }
                add_person(&mut poses.poses, pose);
            }
        }
        if is_all {
            // Every region was processed, so no person is held.
            state.held.clear();
        }
        state.hold(&mut poses.poses, seen, looks);
        state.persons.clear();
        let boxes = poses.poses.iter().filter_map(Pose::bounding_box);
        let corners = boxes.map(|[left, top, width, height]| [left, top, left + width, top + height]);
        state.persons.extend(corners.map(|corners| Region::from_corners(corners, size)));
        match params.track {
            true => state.tracks.update(&image.header, &mut poses.poses, params.smooth),
            false => state.tracks = PoseTracks::default(),
        }
        poses.poses.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        Ok(())
    }
}

impl HighResolutionPoseEstimationState {
    /// Adds the persons whose regions were not processed in this frame. The first `seen` of `poses` are from the first
    /// pass.
    fn hold(&mut self, poses: &mut Vec<Pose>, seen: usize, looks: &[Look]) {
        std::mem::swap(&mut self.held, &mut self.before);
        self.held.clear();
        self.held.extend(poses.iter().skip(seen).map(|pose| Held { pose: pose.clone(), age: 0 }));
        for Held { pose, age } in self.before.drain(..) {
            let Some([left, top, width, height]) = pose.bounding_box() else { continue };
            let (x, y) = (left + width / 2.0, top + height / 2.0);
            let is_processed = looks.iter().any(|look| {
                let [x0, y0, x1, y1] = look.region.corners();
                (x0..x1).contains(&x) && (y0..y1).contains(&y)
            });
            if age < MOST_HELD && !is_processed && !poses.iter().any(|other| is_same(other, &pose)) {
                poses.push(pose.clone());
                self.held.push(Held { pose, age: age + 1 });
            }
        }
    }
}

/// Returns the parameters of the network; the others are not used.
fn network_params(params: &HighResolutionPoseEstimationParams) -> LightweightOpenPoseParams {
    LightweightOpenPoseParams {
        threshold: params.threshold,
        keypoint_threshold: params.keypoint_threshold,
        upsample_ratio: params.upsample_ratio,
        ..LightweightOpenPoseParams::default()
    }
}

/// Adds a person; of two poses of one person the one with the higher score stays.
fn add_person(poses: &mut Vec<Pose>, pose: Pose) {
    match poses.iter_mut().find(|other| is_same(other, &pose)) {
        Some(other) if other.confidence < pose.confidence => *other = pose,
        Some(_) => {}
        None => poses.push(pose),
    }
}

/// Returns whether two poses are one person: the joints that both have are near each other.
fn is_same(a: &Pose, b: &Pose) -> bool {
    let extent = |pose: &Pose| pose.bounding_box().map_or(0.0, |[_, _, width, height]| width.max(height));
    let (mut sum, mut shared) = (0.0, 0.0);
    for (a, b) in a.keypoints.iter().zip(&b.keypoints).filter(|(a, b)| a.is_detected() && b.is_detected()) {
        sum += (a.x - b.x).hypot(a.y - b.y);
        shared += 1.0;
    }
    shared > 0.0 && sum / shared < SAME_PERSON * extent(a).min(extent(b))
}
