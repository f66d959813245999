//! Active perception: cameras that move to see better.
//!
//! A recogniser of single views, a rig that carries out [`Action`](opendr_engine::target::Action)s, and between them a belief over
//! classes, a policy that was trained to move to where the recogniser is certain, and a rule for when to stop.

mod calibration;
mod environment;
mod episode;
mod evidence;
mod fusion;
mod gain;
mod look;
mod mover;
mod observation;
mod recogniser;
mod report;
mod scene;
mod stop;
mod training;

pub mod sphere;

pub use calibration::{Trajectory, fit_fusion, negative_log_likelihood};
pub use environment::ActiveEnvironment;
pub use episode::{ActiveEpisode, run_episode};
pub use evidence::ClassEvidence;
pub use fusion::{Belief, Fusion};
pub use gain::{GainNetwork, GainSamples};
pub use look::Look;
pub use mover::{Greedy, Mover, Oracle, Orbit, PolicyMover, RandomMover, Situation, Stare};
pub use observation::Observer;
pub use recogniser::{LearnerRecogniser, ViewRecogniser};
pub use report::{ActiveReport, CERTAIN};
pub use scene::ActiveScene;
pub use stop::{StopReason, StopRule};
pub use training::{ActiveModel, ActiveTraining, calibrated, train_active};
