//! Wrappers of environments.

mod checked;
mod frame_stack;
mod normalise_observation;
mod normalise_reward;
mod record_episode_statistics;
mod running_moments;
#[cfg(test)]
mod tests;
mod time_limit;

pub use checked::Checked;
pub use frame_stack::FrameStack;
pub use normalise_observation::NormaliseObservation;
pub use normalise_reward::NormaliseReward;
pub use record_episode_statistics::RecordEpisodeStatistics;
pub use running_moments::RunningMoments;
pub use time_limit::TimeLimit;
