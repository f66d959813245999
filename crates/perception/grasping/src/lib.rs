//! Where a robot can grasp, and whether it can be sure of the place.
//!
//! Begin with [`grasp_detection::GrConvNet`]; [`ambiguity_measure::AmbiguityMeasure`] tells whether a map of values leaves a doubt.

pub mod ambiguity_measure;
pub mod grasp_detection;
