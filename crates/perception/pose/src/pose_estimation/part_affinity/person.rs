//! Decoded persons.

use opendr_engine::target::Keypoint;

use super::layout::JOINTS;

/// A person in pixels of the network's input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// Joints in OpenDR's order; the confidence of each is the height of its peak, 0..=1.
    pub joints: [Keypoint; JOINTS],
    /// Mean confidence of the joints, with 0 for missing ones; 0..=1.
    pub score: f32,
}
