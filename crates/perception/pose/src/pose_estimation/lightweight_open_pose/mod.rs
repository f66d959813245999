//! Lightweight OpenPose: poses of several persons by part affinity fields, with identities and smoothed joints in a stream.
//!
//! Osokin, "Real-time 2D Multi-Person Pose Estimation on CPU: Lightweight OpenPose", 2018; OpenDR's default pose estimator,
//! trainable. [`part_affinity`](super::part_affinity) decodes the maps.

#[cfg(feature = "training")]
mod fit;
mod input;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(feature = "training")]
mod person_crop;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::LightweightOpenPoseFitParams;
use input::{InputSize, STRIDE};
use opendr_engine::data::{Image, ImageView};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_vision::{InputGeometry, LetterboxAlign, Preprocess};

use crate::pose_estimation::part_affinity::{DecodeScratch, Grid, PartAffinity, PartMaps, Person};
use crate::pose_estimation::pose_tracks::PoseTracks;

/// Parameters of [`LightweightOpenPose`].
#[derive(Debug, Clone, Params)]
pub struct LightweightOpenPoseParams {
    /// Score below which persons are dropped. The score is the mean over the 18 joints; missing ones count as 0.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which joints are missing.
    #[param(default = 0.1, range = 0.01..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Height of the network's input; its width follows from the image. Larger values detect smaller persons.
    #[param(default = 256, range = 64..=2048, unit = "px", live)]
    pub base_height: usize,
    /// Upsampling factor of the heatmaps for the search of joints.
    #[param(default = 4, range = 1..=8, live)]
    pub upsample_ratio: usize,
    /// Whether persons keep their identity from frame to frame.
    #[param(default = true, live)]
    pub track: bool,
    /// Whether joints are smoothed over frames; needs `track`.
    #[param(default = true, live)]
    pub smooth: bool,
}

/// A loaded Lightweight OpenPose.
pub struct LightweightOpenPose {
    params: LightweightOpenPoseParams,
    network: ImageNetwork,
    size: InputSize,
    heat: usize,
    fields: usize,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    decoding: DecodeScratch,
    persons: Vec<Person>,
}

/// Names of the outputs: heatmaps `[1, 19, rows, columns]` and fields `[1, 38, rows, columns]`.
const OUTPUTS: [&str; 2] = ["heat", "fields"];
/// Mean and scale of the levels, for inputs in -1..=1.
const LEVEL: f32 = 127.5;

/// State of a stream.
#[derive(Default)]
pub struct LightweightOpenPoseState {
    tracks: PoseTracks,
}

impl Learner for LightweightOpenPose {
    const SPEC: Spec = Spec::new("lightweight_open_pose", Task::PoseEstimation)
        .class("LightweightOpenPoseLearner")
        .about("Lightweight OpenPose detects and tracks 18 joints of several persons; trainable.")
        .without_effect(&[
            ("mobilenet_use_stride", "the maps have a stride of 8 pixels"),
            ("shufflenet_groups", "the backbone is MobileNet"),
            ("experiment_name", "the output folder of a training names it"),
            ("weights_only", "`resume` of `fit` sets it"),
            ("output_name", "`eval` writes predictions"),
            ("multiscale", "a larger `base_height` detects smaller persons"),
            ("scales", "a larger `base_height` detects smaller persons"),
            ("visualize", "`draw` draws poses"),
            ("img_mean", "the model defines it"),
            ("img_scale", "the model defines it"),
            ("pad_value", "the model defines it"),
            ("half_precision", "the runtime chooses the precision"),
        ]);
    type Params = LightweightOpenPoseParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = LightweightOpenPoseState;

    fn load(model: &Model, params: LightweightOpenPoseParams, device: Device) -> Result<Self> {
        let mut size = InputSize::Free;
        let network = ImageNetwork::open(model, device, |input| {
            size = InputSize::of_network(&input.dims);
            let [width, height] = size.of_picture([4, 3], params.base_height);
            // The padding is grey, as that of augmented images.
            Preprocess::new(width, height)
                .letterbox(LetterboxAlign::Centre, LEVEL)
                .normalise([LEVEL; 3], [LEVEL; 3])
        })?;
        let [heat, fields] = OUTPUTS;
        let (heat, fields) = (network.output(heat)?, network.output(fields)?);
        Ok(Self { params, network, size, heat, fields, scratch: Pool::default() })
    }

    fn params(&self) -> &LightweightOpenPoseParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut LightweightOpenPoseParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut LightweightOpenPoseState,
        image: &Image,
        poses: &mut PoseList,
    ) -> Result<()> {
        self.follow_with(&self.params, state, image, poses)
    }
}

impl LightweightOpenPose {
    /// As [`Learner::infer_into`], with other parameters than the learner's own.
    pub(crate) fn follow_with(
        &self,
        params: &LightweightOpenPoseParams,
        state: &mut LightweightOpenPoseState,
        image: &Image,
        poses: &mut PoseList,
    ) -> Result<()> {
        let LightweightOpenPoseParams { base_height, track, smooth, .. } = *params;
        poses.poses.clear();
        self.find_with(params, image.view(), base_height, &mut poses.poses, |_| {})?;
        match track {
            true => state.tracks.update(&image.header, &mut poses.poses, smooth),
            false => state.tracks = PoseTracks::default(),
        }
        Ok(())
    }

    /// Adds the persons in a view to `poses`, in its pixels, by the thresholds of `params`, with a network input of
    /// `base_height` pixels height. `sink` receives the maps.
    pub(super) fn find_with(
        &self,
        params: &LightweightOpenPoseParams,
        view: ImageView<'_>,
        base_height: usize,
        poses: &mut Vec<Pose>,
        mut sink: impl FnMut(&PartMaps<'_>),
    ) -> Result<()> {
        let Scratch { decoding, persons } = &mut *self.scratch.take();
        let LightweightOpenPoseParams { keypoint_threshold, upsample_ratio, threshold, .. } = *params;
        let how =
            PartAffinity { peak_threshold: keypoint_threshold, upsample_ratio, ..PartAffinity::default() };
        let size = self.size.of_picture([view.width(), view.height()], base_height);
        self.network.run_sized(view, size, |outputs, geometry| {
            let maps = self.maps(outputs)?;
            sink(&maps);
            how.decode(&maps, decoding, persons);
            let sure = persons.iter().filter(|person| person.score >= threshold);
            poses.extend(sure.map(|person| pose_in_image(person, geometry)));
            Ok(())
        })
    }

    fn maps<'a>(&self, outputs: &[TensorView<'a>]) -> Result<PartMaps<'a>> {
        let [1, _, rows, columns] = *outputs[self.heat].shape() else {
            let shape = outputs[self.heat].shape();
            return Err(Error::format(format!(
                "the heatmaps need the shape [1, 19, rows, columns], not {shape:?}; load another model"
            )));
        };
        let grid = Grid { rows, columns, stride: STRIDE as f32 };
        PartMaps::new(grid, outputs[self.heat].values()?, outputs[self.fields].values()?)
    }
}

/// Converts a person to image pixels; joints in the padding are moved to the image's border.
fn pose_in_image(person: &Person, geometry: &InputGeometry) -> Pose {
    let keypoint = |joint: &Keypoint| {
        if !joint.is_detected() {
            return Keypoint::MISSING;
        }
        let [x, y] = geometry.image_from_input([joint.x, joint.y]);
        let [width, height] = geometry.image_size;
        Keypoint { x: x.clamp(0.0, width), y: y.clamp(0.0, height), ..*joint }
    };
    Pose {
        keypoints: person.joints.iter().map(keypoint).collect(),
        confidence: person.score,
        skeleton: Skeleton::Opendr18,
        ..Pose::default()
    }
}
