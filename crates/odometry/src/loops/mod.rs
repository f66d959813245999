//! Closing of loops: recognition of places and optimisation of the pose graph.

mod envelope;
mod pose_graph;
mod places;
#[cfg(test)]
mod tests;

pub use pose_graph::{Edge, GraphReport, PoseGraph};

pub(crate) use places::Places;
