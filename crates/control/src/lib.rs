//! Classical controllers, policies of robots, online fine-tuning with guard, monitor and rollback.
//!
//! [`Pid`] and [`Lqr`] are feedback laws for one axis and for a linear model. [`TrackingPid`] and [`TrackingLqr`] run them on the
//! observations of an environment, whose places a [`TrackingTask`](opendr_engine::environment::TrackingTask) states, and
//! [`ObservationPid`] and [`ObservationLqr`] on places that you choose. All four are
//! [`Controller`](opendr_engine::environment::Controller)s; [`priors()`] has those of the built-in environments by name.
//! [`online`] adapts a pre-trained policy while it controls.
//!
//! [`MobileRl`] and [`MultiObjectSearchRl`] are policies of robots as learners.
//!
//! Not here: other policies and their training (`opendr-rl`), environments such as `QuadTrack-v1` (`opendr-simulation`).
//!
//! ```
//! use opendr_control::{Pid, PidGains};
//!
//! let mut pid = Pid::new(PidGains { kp: 2.0, ki: 1.0, kd: 0.5, ..PidGains::default() }, 0.01)?;
//! let command = pid.step(0.3, false);
//! assert!(command > 0.6);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod actuator;
mod feedback;
mod learners;
mod lqr;
mod matrix;
pub mod online;
mod pid;
mod priors;
mod tracking;

pub use actuator::Actuator;
pub use feedback::{AxisInput, ObservationLqr, ObservationPid};
pub use learners::{
    MobileRl, MobileRlFitParams, MobileRlMethod, MultiObjectSearchRl, MultiObjectSearchRlFitParams,
    MultiObjectSearchRlMethod, WithResetOptions,
};
pub use lqr::Lqr;
pub use pid::{Pid, PidGains};
pub use priors::{priors, quad_track_gains};
pub use tracking::{TrackingLqr, TrackingPid};
