//! Closing of loops: recognition of places and optimisation of the pose graph.

mod envelope;
mod places;
mod pose_graph;
#[cfg(test)]
mod tests;

pub use pose_graph::{Edge, GraphReport, PoseGraph};

pub(crate) use places::Places;
