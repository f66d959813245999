//! OpenDR in Rust: the open deep-learning toolkit for robotics.
//!
//! Learners by name, from a registry, as every surface has them:
//!
//! ```no_run
//! # fn main() -> opendr::Result<()> {
//! use opendr::learner::Ports;
//!
//! let mut detector = opendr::learner("centernet")?;   // downloads once, with checksum
//! let image = opendr::vision::open("street.jpg")?;
//! println!("{:#}", detector.infer(&Ports::one(&image))?);
//! # Ok(())
//! # }
//! ```
//!
//! or by type, without a dispatch:
//!
//! ```no_run
//! # fn main() -> opendr::Result<()> {
//! use opendr::object_detection_2d::{Nanodet, NanodetParams};
//! use opendr::{Device, learner::Handle};
//!
//! let params = NanodetParams { threshold: 0.5, ..NanodetParams::default() };
//! let mut nanodet = Handle::<Nanodet>::new(params, Device::Auto)?;
//! nanodet.load(opendr::download("nanodet")?)?;
//! let image = opendr::vision::open("street.jpg")?;
//! for found in &nanodet.infer(&image)?.boxes {
//!     println!("{} {:?}", found.name, found.corners());
//! }
//! # Ok(())
//! # }
//! ```

mod by_name;
mod eval_in;
mod export;
mod fit;
mod pipeline;
mod registry;
mod smaller;
mod tune;

pub use by_name::{download, learner, learner_with};
pub use eval_in::{ActingStream, eval_in, trained_in};
pub use export::export;
pub use fit::{
    FitData, FitEnvironments, FitOptions, Fitted, Opening, check_fit, fit, fit_in, teacher, teacher_with,
};
pub use opendr_engine::*;
pub use opendr_perception::{
    activity_recognition, ambiguity_measure, beats, binary_high_resolution, compressive_learning,
    face_detection, face_recognition, facial_expression_recognition, facial_landmarks, fall_detection,
    gesture_recognition, grasp_detection, hand_pose_estimation, heart_anomaly_detection,
    image_classification, instance_segmentation, mfcc, multimodal_human_centric, object_detection_2d,
    object_detection_3d, object_tracking_2d, object_tracking_3d, panoptic_segmentation, pillars,
    pose_estimation, range_image, regions, resampler, semantic_segmentation,
    skeleton_based_action_recognition, speech_recognition, speech_transcription, stereo_matching,
    suppression, tiling, tracking, voice_activity, voice_activity_detection,
};
pub use pipeline::Pipeline;
pub use registry::registry;
pub use smaller::optimize_loaded;
pub use tune::{LearnerTraining, MakeLearner, TuneData, TuneOptions, Tuned, search_space, tune};
pub use {
    opendr_datasets as datasets, opendr_evaluation as evaluation, opendr_inference as inference,
    opendr_metrics as metrics, opendr_optimize as optimize, opendr_planning as planning, opendr_rl as rl,
    opendr_simulation as simulation, opendr_tuning as tuning, opendr_vision as vision, opendr_zoo as zoo,
};
#[cfg(feature = "ros")]
pub use {opendr_recordings as bags, opendr_ros as ros};
