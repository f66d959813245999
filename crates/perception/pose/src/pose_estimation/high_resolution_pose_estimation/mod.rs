//! High-resolution pose estimation: a coarse pass over the whole picture, then a closer look at the parts worth it.
//!
//! After OpenDR's learner of this name (Manousis et al., "Enabling High-Resolution Pose Estimation in Real Time Using
//! Active Perception", ICIP 2023), whose network is Lightweight OpenPose's. Persons of 40 pixels in a 4K picture leave no
//! trace in the coarse heat maps; so regions also come from where the picture has detail, and from where persons were in
//! the frame before. What does not fit into one frame's share of time is looked at in the next ones, in turn; until then its persons stay
//! as they were seen.

mod search;
#[cfg(test)]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Pose, PoseList};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::regions::Region;

use self::search::{Look, Search};
use crate::pose_estimation::lightweight_open_pose::{LightweightOpenPose, LightweightOpenPoseParams};
use crate::pose_estimation::pose_tracks::PoseTracks;

opendr_engine::choices! {
    /// How parts of the picture are chosen.
    pub enum RegionMethod {
        /// One part for each group of cells that touch.
        Adaptive = "adaptive",
        /// One part around all that the coarse heat maps show.
        Primary = "primary",
    }
}

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct HighResolutionPoseEstimationParams {
    /// Height of the network's input for the whole picture.
    #[param(default = 360, range = 64..=2048, unit = "px", live)]
    pub first_pass_height: usize,
    /// Height of the network's input for a part of it, at most; small parts are magnified three times.
    #[param(default = 540, range = 64..=2048, unit = "px", live)]
    pub second_pass_height: usize,
    /// How parts of the picture are chosen.
    #[param(live)]
    pub method: RegionMethod,
    /// What is added around a part on each side, as a share of its longer side.
    #[param(default = 0.3, range = 0.0..=2.0, live)]
    pub percentage_around_crop: f32,
    /// Where the coarse heat maps are above this, a closer look is worth it.
    #[param(default = 0.1, range = 0.01..=1.0, live)]
    pub heatmap_threshold: f32,
    /// Where brightness differs by more than this within 4 pixels of the coarse picture, a closer look is worth it too,
    /// 0..=255; 256 switches it off.
    #[param(default = 32.0, range = 1.0..=256.0, live)]
    pub detail_threshold: f32,
    /// At most this many parts are looked at in one picture; the others follow in the next frames.
    #[param(default = 4, range = 1..=64, live)]
    pub max_regions: usize,
    /// The parts that are looked at in one picture have at most so many pixels for the network, but for the first of them.
    #[param(default = 300_000, range = 1..=100_000_000, unit = "px", live)]
    pub max_pixels: usize,
    /// Persons below this score are dropped.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Joints below this score are missing.
    #[param(default = 0.1, range = 0.01..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Steps between the cells of the heat maps in which joints are looked for.
    #[param(default = 4, range = 1..=8, live)]
    pub upsample_ratio: usize,
    /// Whether persons keep their identity from frame to frame.
    #[param(default = true, live)]
    pub track: bool,
    /// Whether joints are smoothed over frames; needs `track`.
    #[param(default = true, live)]
    pub smooth: bool,
}

/// A loaded network and how it looks twice.
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

/// What a stream remembers: its persons, where they were, and whose turn it is to be looked at.
#[derive(Default)]
pub struct HighResolutionPoseEstimationState {
    size: [usize; 2],
    tracks: PoseTracks,
    persons: Vec<Region>,
    /// Of known persons and of other parts.
    turns: [usize; 2],
    /// Persons that only a closer look shows, as it showed them last.
    held: Vec<Held>,
    before: Vec<Held>,
}

struct Held {
    pose: Pose,
    /// Frames since.
    age: u32,
}

/// A person is told for so many frames without a closer look.
const MOST_HELD: u32 = 10;
/// Joints nearer to each other than this share of the smaller person's extent are those of one person.
const SAME_PERSON: f32 = 0.25;

impl Learner for HighResolutionPoseEstimation {
    const SPEC: Spec = Spec::new("high_resolution_pose_estimation", Task::PoseEstimation)
        .class("HighResolutionPoseEstimationLearner")
        .about("Looks at large pictures twice: coarsely, then closer where persons may be.")
        .without_effect(&[
            ("base_height", "`first_pass_height` and `second_pass_height` say it"),
            ("mobilenet_use_stride", "the maps lie at every 8th pixel"),
            ("shufflenet_groups", "the backbone is MobileNet"),
            ("experiment_name", "it does not train: `lightweight_open_pose` does"),
            ("weights_only", "it does not train: `lightweight_open_pose` does"),
            ("output_name", "`eval` says where answers are written"),
            ("multiscale", "parts are looked at larger than the whole"),
            ("scales", "parts are looked at larger than the whole"),
            ("visualize", "`draw` shows poses"),
            ("img_mean", "the network says what it takes"),
            ("img_scale", "the network says what it takes"),
            ("pad_value", "the network says what it takes"),
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
                grid.mark(|column, row| maps.highest(column, row) > params.heatmap_threshold);
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
                for joint in pose.keypoints.iter_mut().filter(|joint| joint.is_found()) {
                    (joint.x, joint.y) = (joint.x + x as f32, joint.y + y as f32);
                }
                add_person(&mut poses.poses, pose);
            }
        }
        if is_all {
            // Who is not seen now is not there.
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
    /// Adds the persons that were there and that nobody looked for in this frame; of `poses`, the first pass has seen the first
    /// `seen`.
    fn hold(&mut self, poses: &mut Vec<Pose>, seen: usize, looks: &[Look]) {
        std::mem::swap(&mut self.held, &mut self.before);
        self.held.clear();
        self.held.extend(poses.iter().skip(seen).map(|pose| Held { pose: pose.clone(), age: 0 }));
        for Held { pose, age } in self.before.drain(..) {
            let Some([left, top, width, height]) = pose.bounding_box() else { continue };
            let (x, y) = (left + width / 2.0, top + height / 2.0);
            let is_looked_at = looks.iter().any(|look| {
                let [x0, y0, x1, y1] = look.region.corners();
                (x0..x1).contains(&x) && (y0..y1).contains(&y)
            });
            if age < MOST_HELD && !is_looked_at && !poses.iter().any(|other| is_same(other, &pose)) {
                poses.push(pose.clone());
                self.held.push(Held { pose, age: age + 1 });
            }
        }
    }
}

/// What the network is told; the rest it is not asked for.
fn network_params(params: &HighResolutionPoseEstimationParams) -> LightweightOpenPoseParams {
    LightweightOpenPoseParams {
        threshold: params.threshold,
        keypoint_threshold: params.keypoint_threshold,
        upsample_ratio: params.upsample_ratio,
        ..LightweightOpenPoseParams::default()
    }
}

/// Adds a person, or, where it is one that is there already, keeps the one with the higher score.
fn add_person(poses: &mut Vec<Pose>, pose: Pose) {
    match poses.iter_mut().find(|other| is_same(other, &pose)) {
        Some(other) if other.confidence < pose.confidence => *other = pose,
        Some(_) => {}
        None => poses.push(pose),
    }
}

/// Whether two poses are one person, seen twice: the joints that both have lie near each other.
fn is_same(a: &Pose, b: &Pose) -> bool {
    let extent = |pose: &Pose| pose.bounding_box().map_or(0.0, |[_, _, width, height]| width.max(height));
    let (mut sum, mut shared) = (0.0, 0.0);
    for (a, b) in a.keypoints.iter().zip(&b.keypoints).filter(|(a, b)| a.is_found() && b.is_found()) {
        sum += (a.x - b.x).hypot(a.y - b.y);
        shared += 1.0;
    }
    shared > 0.0 && sum / shared < SAME_PERSON * extent(a).min(extent(b))
}
