//! From a depth camera to heading and yaw of a drone: OpenDR's end-to-end planning (Ugurlu, Pham and Kayacan, Sim-to-real
//! deep reinforcement learning for safe end-to-end planning of aerial robots, 2022).

mod dense_episodes;
mod learner;
mod method;
mod stern_rewards;
mod surroundings;

pub use dense_episodes::DenseEpisodes;
pub use learner::{EndToEndPlanningRl, FlightState, surroundings_of};
pub use method::{EndToEndPlanningFitParams, PpoInCorridors};
pub use stern_rewards::SternRewards;
pub use surroundings::learn_surroundings;
