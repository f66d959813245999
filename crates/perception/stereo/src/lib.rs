//! Depth from two cameras, and the obstacles in it.
//!
//! Begin with [`stereo_matching::SemiGlobalMatching`].

pub mod stereo_matching;
