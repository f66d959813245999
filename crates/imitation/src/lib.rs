//! Policies of action chunks that learn from demonstrations: [`Act`] and [`DiffusionPolicy`].
//!
//! A [`DemonstrationSet`] is recorded from a teacher in an environment, or read from a data set of LeRobot. [`ChunkTraining`] trains
//! a [`ChunkPolicy`] on it, on the kernels of `opendr-kernels`; [`ActLearner`] and [`DiffusionPolicyLearner`] are the same as learners,
//! which every surface of OpenDR can load and train. Behaviour cloning of single actions is in `opendr-rl`.

mod act;
mod affine;
mod batch;
mod demonstrations;
mod diffusion;
mod learner;
#[cfg(feature = "lerobot")]
mod lerobot;
mod method;
mod parts;
mod policy;
mod source;
mod training;
mod transformer;

pub use act::{Act, ActConfig, ActMemory, ActParams, ActTape};
pub use demonstrations::{DemonstrationSet, Episode, RecordingOptions};
pub use diffusion::{DiffusionConfig, DiffusionMemory, DiffusionParams, DiffusionPolicy, DiffusionTape};
pub use learner::{
    ActFitParams, ActLearner, DiffusionFitParams, DiffusionPolicyLearner, ImitationLearner, ImitationMethod,
    ImitationState, TeacherParams,
};
#[cfg(feature = "lerobot")]
pub use lerobot::{read_demonstrations, write_demonstrations};
pub use method::ChunkMethod;
pub use policy::{ChunkPolicy, ChunkState};
pub use training::{ChunkTraining, ChunkTrainingParams};
