//! Parameters of a policy at inference.

use opendr_engine::params::Params;

use crate::prior::ShieldParams;

/// Parameters of a policy at inference.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PolicyParams {
    /// Whether the policy takes its most likely actions instead of sampling.
    #[param(default = true, live)]
    pub deterministic: bool,
    /// Seed of sampled actions, at the start of a stream.
    #[param(default = 0)]
    pub seed: u64,
    /// Of the shield.
    #[param(flatten)]
    pub shield: ShieldParams,
}
