//! Active perception: cameras that move to see better.
//!
//! A recogniser of single views, a rig that carries out [`Action`](opendr_engine::target::Action)s, and between them a belief over
//! classes, a policy that was trained to move to where the recogniser is certain, and a rule for when to stop.
//!
//! Begin with [`Active`], which runs a trained [`ActiveModel`] on a rig. [`train_active`] trains one on any [`ActiveScene`];
//! [`sphere::SphereScene`] is one over generated subjects, and `examples/sphere_view.rs` goes the whole way. Rigs are in
//! [`rig`], the rendered one in [`opendr_simulation::sphere_view`].
//!
//! ```
//! use opendr_active::{Belief, Fusion};
//! use opendr_engine::rig::ViewPose;
//!
//! let mut belief = Belief::new(3, Fusion::default())?;
//! let front = ViewPose { distance: 3.0, ..ViewPose::default() };
//! // Seven pictures from one place count as one.
//! for _ in 0..7 {
//!     belief.add(front, &[0.6_f32.ln(), 0.3_f32.ln(), 0.1_f32.ln()])?;
//! }
//! assert!((belief.best().1 - 0.6).abs() < 1e-4);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod active;
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

pub mod rig;
pub mod sphere;

pub use active::{Active, Outcome, View};
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
