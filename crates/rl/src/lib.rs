//! Reinforcement learning and imitation for robots, on a processor: PPO with the semantics of Stable-Baselines3 on networks
//! that are small, hand-batched, and the same bit for bit on any number of threads.

mod algorithm;
mod behaviour_cloning;
mod dqn;
mod episodes;
mod evaluation;
mod interaction;
mod learner;
mod off_policy;
mod onnx;
mod policy;
mod ppo;
mod preset;
pub mod prior;
mod replay_buffer;
mod sac;
mod saved_state;
mod schedule;
mod stable_baselines3;
mod td3;
mod training;
mod twin_critics;

pub use algorithm::{Algorithm, Event, Report};
pub use behaviour_cloning::{BehaviourCloningConfig, Demonstrations, clone_behaviour};
pub use dqn::{Dqn, DqnConfig};
pub use episodes::{Episode, Episodes};
pub use evaluation::{
    EvaluatedEpisode, EvaluationProtocol, EvaluationReport, SuccessRate, evaluate, evaluate_controller,
};
pub use learner::{
    DqnFitParams, DqnLearner, DqnMethod, Method, PolicyLearner, PolicyParams, PolicyState, PpoFitParams,
    PpoLearner, PpoMethod, RlTrainingParams, SacFitParams, SacLearner, SacMethod, Td3FitParams, Td3Learner,
    Td3Method, numbers_from_observation, observation_from_numbers,
};
pub use off_policy::OffPolicyConfig;
pub use onnx::onnx_from_policy;
pub use policy::{
    Acting, Beginning, Bounds, Head, Hidden, NetworkConfig, ObservationEncoder, ObservationNormaliser,
    PictureNetwork, Policy, PolicyMemory,
};
pub use ppo::{Ppo, PpoConfig, Trajectory, generalised_advantages};
pub use preset::Preset;
pub use sac::{Sac, SacConfig};
pub use saved_state::SavedState;
pub use schedule::Schedule;
pub use stable_baselines3::policy_from_stable_baselines3;
pub use td3::{ActionNoise, Td3, Td3Config};
pub use training::{POLICY, fit_policy};
