//! Visual odometry as a learner of streams.

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Odometry, RigidPose};
use opendr_engine::{Device, Error, Result, Task};

use crate::geometry::{PinholeCamera, is_image_size};
use crate::odometry::{CameraFrame, CameraKind, OdometryParams, Tracking, VisualOdometry};

/// Baseline of the emitter of a depth camera, m (Intel RealSense D400, Microsoft Kinect).
const EMITTER: f64 = 0.075;

/// Parameters of [`VisualOdometryLearner`].
#[derive(Debug, Clone, Params)]
pub struct VisualOdometryParams {
    /// Focal length of the camera. Required.
    #[param(default = 0.0, range = 0.0..=1e6, unit = "px")]
    pub focal_length: f64,
    /// Focal length in y; 0 for that in x.
    #[param(default = 0.0, range = 0.0..=1e6, unit = "px")]
    pub focal_length_y: f64,
    /// x of the principal point; -1 for the centre of the image.
    #[param(default = -1.0, range = -1.0..=1e6, unit = "px")]
    pub principal_point_x: f64,
    /// y of the principal point; -1 for the centre of the image.
    #[param(default = -1.0, range = -1.0..=1e6, unit = "px")]
    pub principal_point_y: f64,
    /// Distance between the cameras of a stereo pair; required with `right`. That of the emitter of a depth camera; 0 for 0.075.
    #[param(default = 0.0, range = 0.0..=1000.0, unit = "m")]
    pub baseline: f64,
    /// Number of key frames after which places are recognised and loops are closed, which moves the pose; 0 for never.
    #[param(default = 10, range = 0..=1_000_000)]
    pub loop_interval: usize,
    /// Parameters of the odometry.
    #[param(flatten)]
    pub odometry: OdometryParams,
}

/// One frame: an image, and the image of the right camera or the depths if there are any.
#[derive(Inputs)]
pub struct VisualOdometryInputs<'a> {
    /// Image of the camera, without distortion; the left one of a rectified stereo pair.
    pub image: &'a Image,
    /// Image of the right camera of the pair.
    pub right: Option<&'a Image>,
    /// Depth of each pixel along the optical axis: `f32` in metres or `u16` in millimetres; 0 where it is unknown.
    pub depth: Option<&'a Image>,
}

/// The motion of a camera from its images, one stream each: [`VisualOdometry`] by the interface of all learners. The kind of camera (single,
/// stereo, depth) and its size are those of the first frame.
pub struct VisualOdometryLearner {
    params: VisualOdometryParams,
}

impl VisualOdometryLearner {
    /// Creates the learner; it needs no model.
    pub fn with_params(params: VisualOdometryParams) -> Self {
        Self { params }
    }

    /// Creates the odometry of frames such as this one.
    fn begin(&self, frame: &CameraFrame<'_>) -> Result<VisualOdometry> {
        let params = &self.params;
        if params.focal_length == 0.0 {
            return Err(Error::invalid_param(
                "the focal length is unknown; set focal_length to that of the camera in pixels (fx of its calibration)",
            ));
        }
        let kind = frame.kind();
        let baseline = match kind {
            CameraKind::Stereo if params.baseline == 0.0 => {
                return Err(Error::invalid_param(
                    "the baseline of the stereo pair is unknown; set baseline to the distance between the cameras in metres",
                ));
            }
            CameraKind::Mono | CameraKind::Depth if params.baseline == 0.0 => EMITTER,
            _ => params.baseline,
        };
        let size = [frame.image().width(), frame.image().height()];
        if !is_image_size(size) {
            return Err(Error::invalid_input(format!(
                "an image of {size:?} pixels; visual odometry takes images of 64x64 to 2^24 pixels"
            )));
        }
        let vertical = if params.focal_length_y > 0.0 { params.focal_length_y } else { params.focal_length };
        let centre = [(params.principal_point_x, size[0]), (params.principal_point_y, size[1])]
            .map(|(given, side)| if given >= 0.0 { given } else { (side as f64 - 1.0) / 2.0 });
        let camera = PinholeCamera {
            size,
            focal_length: [params.focal_length, vertical],
            principal_point: centre,
            baseline,
        };
        VisualOdometry::new(camera, kind, params.odometry.clone())
    }
}

impl Learner for VisualOdometryLearner {
    const SPEC: Spec = Spec::new("visual_odometry", Task::VisualOdometry)
        .class("VisualOdometryLearner")
        .about("Estimates the motion of a camera (single, stereo, RGB-D) with loop closure.");
    type Params = VisualOdometryParams;
    type Input<'a> = VisualOdometryInputs<'a>;
    type Target = Odometry;
    type State = Option<VisualOdometry>;

    fn load(_: &Model, params: VisualOdometryParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &VisualOdometryParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut VisualOdometryParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut Option<VisualOdometry>,
        input: VisualOdometryInputs<'_>,
        target: &mut Odometry,
    ) -> Result<()> {
        let frame = match (input.right, input.depth) {
            (None, None) => CameraFrame::Mono(input.image),
            (Some(right), None) => CameraFrame::Stereo { left: input.image, right },
            (None, Some(depth)) => CameraFrame::Depth { image: input.image, depth },
            (Some(_), Some(_)) => {
                return Err(Error::invalid_input("a frame with right and depth; pass one of them"));
            }
        };
        let odometry = match state {
            Some(odometry) => odometry,
            None => state.insert(self.begin(&frame)?),
        };
        (target.pose, target.num_landmarks) = match odometry.track(&frame)? {
            Tracking::Tracked { inliers, is_key_frame, .. } => {
                let interval = self.params.loop_interval;
                if is_key_frame && interval > 0 && odometry.key_frames().is_multiple_of(interval) {
                    odometry.close_loops()?;
                }
                let pose = odometry.pose();
                let pose = RigidPose { position: pose.position, orientation: pose.quaternion() };
                (Some(pose), u32::try_from(inliers).unwrap_or(u32::MAX))
            }
            Tracking::Starting | Tracking::Lost { .. } => (None, 0),
        };
        Ok(())
    }
}
