//! Reinforcement learning and behaviour cloning of small policies on a CPU.
//!
//! The algorithms [`Ppo`], [`Sac`], [`Td3`] and [`Dqn`] follow Stable-Baselines3 in semantics, names and defaults. Networks are
//! small, with gradients written by hand; results are the same bit for bit with any number of threads, and after a resumed
//! training. [`clone_behaviour`] trains on demonstrations, [`evaluate`] measures a policy on fixed episodes,
//! [`onnx_from_policy`] exports it and [`policy_from_stable_baselines3`] imports one. [`PpoLearner`] and its siblings are policies as
//! learners, which every surface of OpenDR can load and train.
//!
//! Environments, their vectors and wrappers are in `opendr-simulation`, the trait `Environment` and spaces in `opendr-engine`, layers
//! and optimisers in `opendr-kernels`.
//!
//! Begin with [`Ppo`] and the trait [`Algorithm`]:
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use opendr_rl::{Algorithm as _, EvaluationProtocol, Ppo, PpoConfig, evaluate};
//! use opendr_simulation::vector::{Autoreset, VectorOptions};
//!
//! let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(4) };
//! let mut environments = opendr_simulation::make_vec("CartPole-v1", options)?;
//! let config = PpoConfig { n_steps: 64, ..PpoConfig::default() };
//! let mut ppo = Ppo::new(&config, environments.spec())?;
//! ppo.train(&mut *environments, 1024, &mut |_| Ok(ControlFlow::Continue(())))?;
//!
//! let protocol = EvaluationProtocol { episodes: 5, ..EvaluationProtocol::default() };
//! let report = evaluate(ppo.policy(), &mut *opendr_simulation::make("CartPole-v1")?, &protocol)?;
//! assert_eq!(report.episodes.len(), 5);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod algorithm;
mod behaviour_cloning;
mod dqn;
mod episodes;
mod evaluation;
mod evaluation_history;
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

pub use algorithm::{Algorithm, IterationEvent, Report};
pub use behaviour_cloning::{BehaviourCloningConfig, Demonstrations, clone_behaviour};
pub use dqn::{Dqn, DqnConfig};
pub use episodes::{Episode, Episodes};
pub use evaluation::{
    EvaluatedEpisode, EvaluationProtocol, EvaluationReport, SuccessRate, evaluate, evaluate_controller,
    evaluate_under,
};
pub use learner::{
    DqnFitParams, DqnLearner, DqnMethod, Method, PolicyLearner, PolicyParams, PolicyState, PpoFitParams,
    PpoLearner, PpoMethod, RlTrainingParams, SacFitParams, SacLearner, SacMethod, Td3FitParams, Td3Learner,
    Td3Method, numbers_from_observation, observation_from_numbers,
};
pub use off_policy::OffPolicyConfig;
pub use onnx::onnx_from_policy;
pub use policy::{
    ActionMode, ActivationFn, Bounds, Head, ImageNetwork, NetworkConfig, ObservationEncoder,
    ObservationNormaliser, ParameterInit, Policy, PolicyMemory, SpaceRecord, TensorFile,
};
pub use ppo::{Ppo, PpoConfig, Trajectory, generalised_advantages};
pub use preset::Preset;
pub use sac::{Sac, SacConfig};
pub use saved_state::SavedState;
pub use schedule::Schedule;
pub use stable_baselines3::policy_from_stable_baselines3;
pub use td3::{ActionNoise, Td3, Td3Config};
pub use training::{POLICY_FILE, fit_policy};
