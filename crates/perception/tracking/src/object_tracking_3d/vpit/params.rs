//! Parameters of the learner.

use opendr_engine::params::Params;

/// Parameters of [`Vpit`](super::Vpit).
#[derive(Debug, Clone, Params)]
pub struct VpitParams {
    /// Weight of the window that penalises positions far from the expected one.
    #[param(default = 0.4, range = 0.0..=1.0, live)]
    pub window_influence: f32,
    /// Factor of the scores of rotations other than the expected one.
    #[param(default = 0.98, range = 0.0..=1.0, live)]
    pub rotation_penalty: f32,
    /// Step between the rotations that are compared.
    #[param(default = 0.15, range = 0.01..=1.0, unit = "rad", live)]
    pub rotation_step: f32,
    /// Number of rotations that are compared, the expected one in the middle; an even number counts as one more.
    #[param(default = 3, range = 1..=9, live)]
    pub rotations_count: usize,
    /// Margin around an object, in its mean sides.
    #[param(default = 0.25, range = 0.0..=2.0)]
    pub context_amount: f32,
    /// Weight of every later view in the features of the object; 0 as in OpenDR.
    #[param(default = 0.0, range = 0.0..=1.0, live)]
    pub target_feature_merge_scale: f32,
    /// Prediction of the object's position.
    #[param(live)]
    pub extrapolation_mode: Extrapolation,
    /// Share of the offset to the detected position by which the box moves.
    #[param(default = 1.0, range = 0.0..=1.0, live)]
    pub offset_interpolation: f32,
    /// Share of the vertical offset by which the box moves.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub vertical_offset_interpolation: f32,
    /// Score below which the object counts as lost: the box moves to the expected position.
    #[param(default = 0.0, range = 0.0..=1.0, live)]
    pub min_top_score: f32,
}

opendr_engine::choices! {
    /// Prediction of an object's position.
    pub enum Extrapolation {
        /// Moves by the mean step of the last scans.
        LinearPlus = "linear+",
        /// Moves by the last step.
        Linear = "linear",
        /// Does not move.
        None = "none",
    }
}
