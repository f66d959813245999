//! Learners of active perception: classify a subject from several views, and propose the motion to the next one.

mod active_learner;
mod container;
mod fit;
mod kind;
mod params;
mod state;

pub use active_learner::{ActiveInput, ActiveLearner};
pub use container::{ActiveContainer, write_active_model};
pub use kind::{ActiveKind, has_camera_policy};
pub use params::{ActiveFitParams, ActiveParams};
pub use state::ActiveState;

/// Active face recognition (OpenDR's `ActiveFaceRecognitionLearner`).
pub type ActiveFaceRecognition = ActiveLearner<kind::Face>;

/// Active object recognition.
pub type ActiveObjectRecognition = ActiveLearner<kind::Object>;

/// Active recognition of body poses.
pub type ActivePoseRecognition = ActiveLearner<kind::BodyPose>;
