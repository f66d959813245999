//! OpenDR in Rust: the open deep-learning toolkit for robotics.
//!
//! The facade of the workspace: the [registry](registry()) of learners, [learners and models by name](learner()), [pipelines](Pipeline),
//! training ([`fit()`], [`fit_policy`]), hyperparameter search ([`tune()`]), [`export()`], and re-exports of the other crates. Algorithms are in
//! the crates of `crates/perception`, data types and the trait `Learner` in `opendr-engine`; the command line, Python and C are in
//! `apps` and `bindings`. Begin with [`learner()`]:
//!
//! ```no_run
//! # fn main() -> opendr::Result<()> {
//! use opendr::learner::Ports;
//!
//! let mut detector = opendr::learner("centernet")?;   // downloads the model once, checked by SHA-256
//! let image = opendr::vision::open("street.jpg")?;
//! println!("{:#}", detector.infer(&Ports::one(&image))?);
//! # Ok(())
//! # }
//! ```
//!
//! A learner is also available by its type, without dynamic dispatch:
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
//! for detection in &nanodet.infer(&image)?.boxes {
//!     println!("{} {:?}", detection.name, detection.corners());
//! }
//! # Ok(())
//! # }
//! ```
//!
//! The registry lists the learners of this build:
//!
//! ```
//! for entry in opendr::registry().entries() {
//!     println!("{}: {}", entry.spec.name, entry.spec.about);
//! }
//! assert!(opendr::registry().find("no_such_learner").is_err());
//! ```

/// The programs of the tutorial are documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/tutorials/rust.md")]
struct Tutorial;

mod by_name;
pub mod data_generation;
pub mod environments;
mod export;
mod fit;
mod online;
mod pipeline;
mod policy_evaluation;
mod priors;
mod registry;
mod smaller;
#[cfg(any(feature = "detection", feature = "segmentation"))]
pub mod tiling;
mod tune;

pub use by_name::{download, learner, learner_with, models};
pub use export::{export, network};
pub use fit::{
    FitData, FitEnvironments, FitOptions, Fitted, check_fit, fit, fit_active, fit_policy, teacher,
    teacher_with,
};
pub use online::{OnlineReport, OnlineTuning, TrackingResult};
#[cfg(feature = "actions")]
pub use opendr_actions::{activity_recognition, skeleton_based_action_recognition};
pub use opendr_audio::{mfcc, resampler};
#[cfg(feature = "classification")]
pub use opendr_classification::{compressive_learning, image_classification};
#[cfg(feature = "clouds")]
pub use opendr_clouds::{object_detection_3d, pillars, range_image};
#[cfg(feature = "depth")]
pub use opendr_depth::depth_estimation;
#[cfg(feature = "detection")]
pub use opendr_detection::object_detection_2d;
pub use opendr_engine::*;
#[cfg(feature = "faces")]
pub use opendr_face_detection::face_detection;
#[cfg(feature = "faces")]
pub use opendr_faces::{face_recognition, facial_expression_recognition, facial_landmarks};
#[cfg(feature = "grasping")]
pub use opendr_grasping::{ambiguity_measure, grasp_detection};
#[cfg(feature = "hands")]
pub use opendr_hands::{gesture_recognition, hand_pose_estimation};
#[cfg(feature = "lerobot")]
pub use opendr_lerobot as lerobot;
#[cfg(feature = "multimodal")]
pub use opendr_multimodal::multimodal_human_centric;
#[cfg(feature = "odometry")]
pub use opendr_odometry as visual_odometry;
#[cfg(feature = "panoptic")]
pub use opendr_panoptic::panoptic_segmentation;
pub use opendr_perception_common::{regions, suppression};
#[cfg(feature = "pose")]
pub use opendr_pose::{fall_detection, pose_estimation};
#[cfg(feature = "segmentation")]
pub use opendr_segmentation::{binary_high_resolution, instance_segmentation, semantic_segmentation};
#[cfg(feature = "signals")]
pub use opendr_signals::{beats, heart_anomaly_detection, sequence_classification};
#[cfg(feature = "speech")]
pub use opendr_speech::{speech_recognition, speech_transcription, voice_activity, voice_activity_detection};
#[cfg(feature = "stereo")]
pub use opendr_stereo::stereo_matching;
#[cfg(feature = "text")]
pub use opendr_text::text_recognition;
#[cfg(feature = "tracking")]
pub use opendr_tracking::{object_tracking_2d, object_tracking_3d, tracking};
#[cfg(feature = "viewer")]
pub use opendr_viewer as viewer;
#[cfg(feature = "webots")]
pub use opendr_webots as webots;
pub use pipeline::Pipeline;
pub use policy_evaluation::{
    PolicyController, PolicyEpisodes, PolicyEvaluation, evaluate_episodes, evaluate_learner, evaluate_policy,
    join_episodes, training_environment,
};
pub use priors::{prior, priors};
pub use registry::registry;
pub use smaller::optimize_loaded;
pub use tune::{
    LearnerTraining, MakeLearner, STUDY_JOURNAL, TuneData, TuneOptions, Tuned, search_space, tune,
};
pub use {
    opendr_active as active, opendr_control as control, opendr_datasets as datasets,
    opendr_evaluation as evaluation, opendr_imitation as imitation, opendr_inference as inference,
    opendr_manipulation as manipulation, opendr_metrics as metrics, opendr_optimize as optimize,
    opendr_planning as planning, opendr_rl as rl, opendr_runlog as runlog, opendr_simulation as simulation,
    opendr_tuning as tuning, opendr_vision as vision, opendr_zoo as zoo,
};
#[cfg(feature = "ros")]
pub use {opendr_recordings as bags, opendr_ros as ros};
