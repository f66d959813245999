//! Policies for robots as learners, trained by PPO.

mod mobile_manipulation;
mod object_search;
mod with_reset_options;

use opendr_rl::PolicyLearner;

pub use mobile_manipulation::{MobileRlFitParams, MobileRlMethod};
pub use object_search::{MultiObjectSearchRlFitParams, MultiObjectSearchRlMethod};
pub use with_reset_options::WithResetOptions;

/// Moves the base of a mobile manipulator so that its arm can follow a planned motion (OpenDR's `MobileRLLearner`).
pub type MobileRl = PolicyLearner<MobileRlMethod>;
/// Searches a flat for objects by choosing where to drive next (OpenDR's `MultiObjectSearchRLLearner`).
pub type MultiObjectSearchRl = PolicyLearner<MultiObjectSearchRlMethod>;
