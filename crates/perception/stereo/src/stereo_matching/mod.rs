//! Stereo matching.

mod obstacles;
mod semi_global_matching;

pub use obstacles::{ObstacleOptions, Obstacles};
pub use semi_global_matching::{
    SemiGlobalMatching, SemiGlobalMatchingInputs, SemiGlobalMatchingParams, SemiGlobalMatchingTargets,
};
