//! Active perception: a camera moves to where its recogniser is certain.
//!
//! A recogniser of single views, a rig that carries out [`Action`](opendr_engine::target::Action)s, and between them a belief over
//! classes, a camera policy, and a stop rule. The policy is trained with PPO in environments that report the true class.
//!
//! Begin with [`Active`], which runs a trained [`ActiveModel`] on a rig, or with the learner [`ActiveFaceRecognition`], which is
//! trained by `opendr fit active_face_recognition --env SphereView-Face-v1`. [`train_active`] trains on any [`ActiveScene`];
//! [`EnvironmentScene`] is one in an environment. Rigs without a simulator are in [`rig`].
//!
//! ```
//! use opendr_active::{Belief, Fusion};
//! use opendr_engine::rig::ViewPose;
//!
//! let mut belief = Belief::new(3, Fusion::default())?;
//! let front = ViewPose { distance: 3.0, ..ViewPose::default() };
//! // Seven images from one pose count as one.
//! for _ in 0..7 {
//!     belief.add(front, &[0.6_f32.ln(), 0.3_f32.ln(), 0.1_f32.ln()])?;
//! }
//! assert!((belief.best().1 - 0.6).abs() < 1e-4);
//! // One from the side adds to it.
//! belief.add(ViewPose { azimuth: 1.5, ..front }, &[0.6_f32.ln(), 0.3_f32.ln(), 0.1_f32.ln()])?;
//! assert!(belief.best().1 > 0.7);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod active;
mod any_recogniser;
mod best_view;
mod calibration;
mod camera_policy;
mod comparison;
mod environment;
mod environment_rig;
mod environment_scene;
mod episode;
mod episode_strip;
mod evidence;
mod fusion;
mod gain;
mod learner;
mod model;
mod observation;
mod parameter_bytes;
mod recogniser;
mod report;
mod rgb_image;
mod scene;
mod session;
mod stop;
mod training;
mod view_classifier;
mod view_loop;
mod view_network;

pub mod rig;

pub use active::{Active, Outcome, View};
pub use any_recogniser::{AnyRecogniser, write_evidence};
pub use best_view::{BestView, BestViewBelief, BestViewEstimate, BestViewEstimator, fit_best_view};
pub use calibration::{Trajectory, fit_fusion, negative_log_likelihood};
pub use camera_policy::{
    CameraContext, CameraPolicy, GreedyPolicy, OracleBaseline, OrbitBaseline, RandomBaseline, StaticBaseline,
    TrainedPolicy,
};
pub use comparison::{Comparison, ComparisonRow, FIRST_EVALUATION_SEED, compare};
pub use environment::ActiveEnvironment;
pub use environment_rig::EnvironmentRig;
pub use environment_scene::EnvironmentScene;
pub use episode::{ActiveEpisode, run_episode};
pub use episode_strip::EpisodeStrip;
pub use evidence::{ClassEvidence, logarithms};
pub use fusion::{Belief, Fusion};
pub use gain::{GainNetwork, GainSamples};
pub use learner::{
    ActiveContainer, ActiveFaceRecognition, ActiveFitParams, ActiveInput, ActiveKind, ActiveLearner,
    ActiveObjectRecognition, ActiveParams, ActivePoseRecognition, ActiveState, has_camera_policy,
    write_active_model,
};
pub use model::ActiveModel;
pub use observation::Observer;
pub use recogniser::{LearnerRecogniser, ViewRecogniser};
pub use report::{ActiveReport, CERTAIN};
pub use scene::ActiveScene;
pub use session::{ActiveSession, Decision};
pub use stop::{StopReason, StopRule};
pub use training::{ActiveTraining, calibrated, train_active};
pub use view_classifier::{
    ViewClassifier, ViewClassifierConfig, ViewTraining, fit_view_classifier, fit_view_networks,
};
pub use view_loop::ViewLoop;
pub use view_network::{FreshViews, LabelledViews, ViewNetworkConfig, ViewSource};
