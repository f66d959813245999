//! End-to-end planning from a depth camera to heading and yaw of a drone, as in OpenDR (Ugurlu, Pham and Kayacan,
//! Sim-to-real deep reinforcement learning for safe end-to-end planning of aerial robots, 2022).

mod cross_entropy;
mod dense_episodes;
mod fit;
mod flight_models;
mod foresight;
mod learner;
mod method;
mod stern_rewards;
mod surroundings;

pub use dense_episodes::DenseObstacles;
pub use flight_models::FlightModels;
pub use foresight::learn_foresight;
pub use learner::{EndToEndPlanningRl, FlightParams, FlightState};
pub use method::{EndToEndPlanningFitParams, PpoInCorridors};
pub use stern_rewards::TrainingRewards;
pub use surroundings::learn_surroundings;
