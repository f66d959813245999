//! Prior knowledge: controllers that policies start from, command, learn from, or are guarded by.
//!
//! A [`Controller`](opendr_engine::environment::Controller) (a feedback law, a planner, a closure) enters a policy in four ways:
//!
//! 1. [`Residual`]: the policy corrects the controller's actions. [`ResidualConfig`] has the settings that go with it, and
//!    [`ResidualLearner`] saves policy and prior as one learner.
//! 2. [`Commanded`]: the policy commands references or gains, and the controller makes the actions. [`ShapedLearner`] saves both as one
//!    learner.
//! 3. [`DemonstratedSteps`]: a share of every minibatch of SAC or TD3 ([`Sac::set_demonstrations`](crate::Sac::set_demonstrations)), or
//!    the behaviour that a policy begins with ([`begin_as_clone`]).
//! 4. [`Shield`]: the controller acts where a predicate calls the policy's action unsafe.
//!
//! [`PriorReport`] measures prior, policy and both on the same episodes.

mod action_shaping;
mod alpha;
mod builtin;
mod commanding_policy;
mod demonstration_params;
mod demonstrations;
mod library;
mod model_controllers;
mod named_prior;
mod prior_record;
mod report;
mod residual;
mod residual_config;
mod residual_controller;
mod residual_learner;
mod safety_rule;
mod shaped_learner;
mod shaping_config;
mod shield;
mod shield_params;

pub use action_shaping::{BoxedCommanded, CommandLaw, Commanded, CommandedController};
pub use alpha::AlphaSchedule;
pub use commanding_policy::CommandingPolicy;
pub use demonstration_params::{
    ClonedDemonstrations, Demonstrating, MakeEnvironment, ReplayedDemonstrations,
};
pub(crate) use demonstrations::DemonstrationReplay;
pub use demonstrations::{DemonstratedSteps, begin_as_clone};
pub use model_controllers::{ModelController, controllers_of_model};
pub use named_prior::{BoxedController, Prior, PriorId, unread_space};
pub use report::{PriorReport, ReportedController};
pub use residual::{Residual, begin_as_prior};
pub use residual_config::ResidualConfig;
pub use residual_controller::ResidualController;
pub use residual_learner::{
    ResidualLearner, ResidualMethod, ResidualPpoFitParams, ResidualPpoLearner, ResidualPpoMethod,
    ResidualSacFitParams, ResidualSacLearner, ResidualSacMethod, ResidualTd3FitParams, ResidualTd3Learner,
    ResidualTd3Method,
};
pub use safety_rule::SafetyRule;
pub use shaped_learner::{
    ShapedLearner, ShapedMethod, ShapedPpoFitParams, ShapedPpoLearner, ShapedPpoMethod, ShapedSacFitParams,
    ShapedSacLearner, ShapedSacMethod,
};
pub use shaping_config::ShapingConfig;
pub use shield::{Predicate, Shield, ShieldedController, ShieldedVector};
pub use shield_params::ShieldParams;
