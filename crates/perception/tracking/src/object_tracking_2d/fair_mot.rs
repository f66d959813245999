//! Detector and tracker in one learner, with the interface of OpenDR's FairMOT.
//!
//! It is not FairMOT's network (Y. Zhang et al., IJCV 2021), which has no freely usable weights: NanoDet detects the
//! persons, [`ByteTrack`] tracks them, and the motion of the camera is estimated from the frames.

use opendr_detection::object_detection_2d::{Nanodet, NanodetParams};
use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes, Name, TrackingAnnotationList};
use opendr_engine::{Device, Result, Task};

use super::{ByteTrack, ByteTrackParams, ByteTrackState, TrackerInputs};

/// Parameters of [`FairMot`].
#[derive(Debug, Clone, Params)]
pub struct FairMotParams {
    /// Score above which detections are associated first; 0.1 more starts a track.
    #[param(default = 0.3, range = 0.1..=1.0, live)]
    pub threshold: f32,
    /// Number of frames that a track is kept without a detection.
    #[param(default = 30, range = 0..=1000, live)]
    pub track_buffer: u32,
    /// Area below which boxes are ignored.
    #[param(default = 100.0, range = 0.0..=1e6, unit = "px^2", live)]
    pub min_box_area: f32,
    /// Whether all classes of the detector are tracked, instead of persons only.
    #[param(default = false, live)]
    pub every_class: bool,
    /// Whether the motion of the camera is compensated; a fixed camera does not need it.
    #[param(default = true, live)]
    pub camera_motion: bool,
}

/// A loaded detector with its tracker.
pub struct FairMot {
    params: FairMotParams,
    detector: Nanodet,
    /// The detector's class index of persons.
    person: Option<i64>,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct FairMotState {
    tracks: ByteTrackState,
    found: BoundingBoxList,
}

/// Name of the detector in the container.
const DETECTOR: &str = "detector";
/// Score below which detections are noise.
const LOWEST: f32 = 0.1;

impl Learner for FairMot {
    const SPEC: Spec = Spec::new("fair_mot", Task::ObjectTracking2d)
        .class("ObjectTracking2DFairMotLearner")
        .about("NanoDet and ByteTrack in one learner track the persons in a video.")
        .without_effect(&[
            ("backbone", "the detector is NanoDet"),
            ("network_head", "the detector is NanoDet"),
            ("scale", "the detector scales frames itself"),
            ("num_classes", "`every_class` selects the tracked classes"),
            ("max_objs", "the detector returns at most 100 boxes"),
            ("frame_rate", "`track_buffer` counts frames"),
            ("image_mean", "the detector defines it"),
            ("image_std", "the detector defines it"),
            ("lr", Spec::TRAINING_ONLY),
            ("iters", Spec::TRAINING_ONLY),
            ("batch_size", Spec::TRAINING_ONLY),
            ("optimizer", Spec::TRAINING_ONLY),
            ("lr_schedule", Spec::TRAINING_ONLY),
            ("lr_step", Spec::TRAINING_ONLY),
            ("num_epochs", Spec::TRAINING_ONLY),
            ("checkpoint_after_iter", Spec::TRAINING_ONLY),
            ("checkpoint_load_iter", Spec::TRAINING_ONLY),
            ("num_workers", Spec::TRAINING_ONLY),
            ("gpus", Spec::TRAINING_ONLY),
            ("mse_loss", Spec::TRAINING_ONLY),
            ("reg_loss", Spec::TRAINING_ONLY),
            ("hm_weight", Spec::TRAINING_ONLY),
            ("wh_weight", Spec::TRAINING_ONLY),
            ("off_weight", Spec::TRAINING_ONLY),
            ("id_weight", Spec::TRAINING_ONLY),
            ("head_conv", "the detector is NanoDet"),
            ("ltrb", "the detector is NanoDet"),
            ("reg_offset", "the detector is NanoDet"),
            ("dense_wh", "the detector is NanoDet"),
            ("cat_spec_wh", "the detector is NanoDet"),
            ("norm_wh", "the detector is NanoDet"),
            ("reid_dim", "the detector is NanoDet"),
            ("down_ratio", "the detector is NanoDet"),
            ("use_pretrained_backbone", Spec::TRAINING_ONLY),
        ]);
    type Params = FairMotParams;
    type Input<'a> = &'a Image;
    type Target = TrackingAnnotationList;
    type State = FairMotState;

    fn load(model: &Model, params: FairMotParams, device: Device) -> Result<Self> {
        let detector_params = NanodetParams { threshold: LOWEST, ..NanodetParams::default() };
        let detector = Nanodet::load(&model.part(DETECTOR)?, detector_params, device)?;
        let person = detector.classes().index("person");
        Ok(Self { params, detector, person })
    }

    fn params(&self) -> &FairMotParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FairMotParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.detector.classes()
    }

    fn infer_into(
        &self,
        state: &mut FairMotState,
        image: &Image,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        let FairMotParams { threshold, track_buffer, min_box_area, every_class, camera_motion } = self.params;
        let FairMotState { tracks, found } = state;
        self.detector.infer_into(&mut (), image, found)?;
        let person = self.person.map(Name::Index).filter(|_| !every_class);
        found.boxes.retain(|found| {
            found.area() >= min_box_area && person.as_ref().is_none_or(|person| found.name == *person)
        });
        let tracker = ByteTrack::with_params(ByteTrackParams {
            threshold,
            low_threshold: LOWEST,
            new_threshold: (threshold + LOWEST).min(1.0),
            track_buffer,
            ..ByteTrackParams::default()
        });
        let input = TrackerInputs { detections: found, image: camera_motion.then_some(image) };
        tracker.infer_into(tracks, input, target)
    }
}
