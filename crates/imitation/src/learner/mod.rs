//! Policies of action chunks as learners.

mod fit;
mod imitation_learner;
mod method;

pub use imitation_learner::{ImitationLearner, ImitationState};
pub use method::{ActFitParams, DiffusionFitParams, ImitationMethod, TeacherParams};

use crate::{Act, DiffusionPolicy};

/// Action chunking with transformers.
pub type ActLearner = ImitationLearner<Act>;
/// Diffusion policy.
pub type DiffusionPolicyLearner = ImitationLearner<DiffusionPolicy>;
