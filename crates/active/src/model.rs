//! A trained camera policy with fusion, expected gain and stop rule.

use opendr_engine::rig::ViewAxis;
use opendr_rl::Policy;

use crate::best_view::BestViewEstimator;
use crate::fusion::Fusion;
use crate::gain::GainNetwork;
use crate::stop::StopRule;

/// The part of active perception that does not depend on the recogniser.
#[derive(Debug, Clone)]
pub struct ActiveModel {
    /// Chooses motions.
    pub policy: Policy,
    /// Estimates the direction to the best view; `None` where the environment of the training does not report that direction.
    pub best_view: Option<BestViewEstimator>,
    /// Fusion of views.
    pub fusion: Fusion,
    /// Predicts the gain of a motion.
    pub gain: GainNetwork,
    /// When a run ends.
    pub stop: StopRule,
    /// Axes of the rig of the training.
    pub axes: Vec<ViewAxis>,
}
