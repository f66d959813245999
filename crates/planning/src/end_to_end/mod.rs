//! From a depth camera to heading and yaw of a drone: OpenDR's end-to-end planning (Ugurlu, Pham and Kayacan, Sim-to-real
//! deep reinforcement learning for safe end-to-end planning of aerial robots, 2022).

mod depth_pilot;
mod learner;
mod params;
mod stern_rewards;

pub use depth_pilot::DepthPilot;
pub use learner::EndToEndPlanning;
pub use params::EndToEndPlanningParams;
pub use stern_rewards::SternRewards;
