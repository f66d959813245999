//! Policies as learners, trained by one of the methods of this crate.

mod method;
mod observation;
mod policy_learner;
mod policy_params;
mod training_params;

pub use method::{
    DqnFitParams, DqnMethod, Method, PpoFitParams, PpoMethod, SacFitParams, SacMethod, Td3FitParams,
    Td3Method,
};
pub use observation::{numbers_from_observation, observation_from_numbers};
pub use policy_learner::{PolicyLearner, PolicyState};
pub use policy_params::PolicyParams;
pub use training_params::RlTrainingParams;
pub(crate) use training_params::over_preset;

/// Proximal policy optimisation.
pub type PpoLearner = PolicyLearner<PpoMethod>;
/// Soft actor-critic.
pub type SacLearner = PolicyLearner<SacMethod>;
/// Twin delayed deep deterministic policy gradient.
pub type Td3Learner = PolicyLearner<Td3Method>;
/// Deep Q-learning.
pub type DqnLearner = PolicyLearner<DqnMethod>;
