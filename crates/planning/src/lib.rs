//! Planning of motion.

mod end_to_end;

pub use end_to_end::{DepthPilot, EndToEndPlanning, EndToEndPlanningParams, SternRewards};
