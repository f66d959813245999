//! Chains of joints, and their forward kinematics.

use opendr_engine::{Error, Result};

use super::joint::Joint;
use super::transform::Transform;
use super::urdf::connections;

/// The joints between the root of a robot and one of its links.
#[derive(Debug, Clone, PartialEq)]
pub struct SerialChain {
    pub(super) joints: Vec<Joint>,
    /// Pose of the tip in the frame of the last joint.
    pub(super) tip: Transform,
}

impl SerialChain {
    /// Reads the chain from the root of a URDF to the link `tip`. Fixed joints become part of the joints behind them.
    ///
    /// # Errors
    /// `Format` for text that is no URDF or has a cycle, `NotFound` for an unknown link, `Unsupported` for joints that are neither
    /// fixed, revolute nor continuous.
    pub fn from_urdf(text: &str, tip: &str) -> Result<Self> {
        let connections = connections(text)?;
        let known = connections.iter().any(|connection| connection.child == tip);
        if !known {
            let links: Vec<_> = connections.iter().map(|connection| connection.child.as_str()).collect();
            return Err(Error::not_found(format!("no link {tip:?}; the URDF has {}", links.join(", "))));
        }
        let (mut link, mut path) = (tip, Vec::new());
        while let Some(before) = connections.iter().find(|connection| connection.child == link) {
            path.push(before);
            link = &before.parent;
            if path.len() > connections.len() {
                return Err(Error::format(format!("the joints above the link {tip:?} form a cycle")));
            }
        }
        let (mut joints, mut rest) = (Vec::new(), Transform::default());
        for connection in path.into_iter().rev() {
            let origin = rest.then(&connection.joint.origin);
            rest = match connection.movable {
                true => {
                    joints.push(Joint { origin, ..connection.joint.clone() });
                    Transform::default()
                }
                false => origin,
            };
        }
        Ok(Self { joints, tip: rest })
    }

    /// Returns the joints, from the root to the tip.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Returns the pose of the tip for the angles of the joints, in radians; missing angles are 0.
    pub fn forward(&self, angles: &[f64]) -> Transform {
        self.frames(angles).last().map_or(self.tip, |last| last.then(&self.tip))
    }

    /// Returns the poses of the joints for their angles.
    pub fn frames(&self, angles: &[f64]) -> impl Iterator<Item = Transform> {
        let angles = angles.iter().copied().chain(std::iter::repeat(0.0));
        self.joints.iter().zip(angles).scan(Transform::default(), |frame, (joint, angle)| {
            *frame = frame.then(&joint.origin).then(&Transform::about(joint.axis, angle));
            Some(*frame)
        })
    }
}
