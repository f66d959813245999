//! Poses over time.

use opendr_engine::{Error, Result};

use crate::geometry::{Pose, Similarity3};

/// A pose with its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stamped {
    /// Time in seconds.
    pub time: f64,
    /// Pose of the camera in the world, `world_from_camera`.
    pub pose: Pose,
}

/// Poses of a camera in increasing time. Frames without a pose, such as those where tracking was lost, are missing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trajectory {
    poses: Vec<Stamped>,
}

impl Trajectory {
    /// Creates a trajectory.
    ///
    /// # Errors
    /// `InvalidInput` when times do not increase, or a number is not finite.
    pub fn new(poses: Vec<Stamped>) -> Result<Self> {
        if let Some(at) =
            poses.iter().position(|stamped| !stamped.time.is_finite() || !stamped.pose.is_finite())
        {
            return Err(Error::invalid_input(format!(
                "pose {at} of the trajectory is not finite; leave it out"
            )));
        }
        if let Some(at) = poses.windows(2).position(|pair| pair[1].time <= pair[0].time) {
            return Err(Error::invalid_input(format!(
                "pose {} of the trajectory is at {} s, not after the one before at {} s; sort poses by time and remove repeated ones",
                at + 1,
                poses[at + 1].time,
                poses[at].time
            )));
        }
        Ok(Self { poses })
    }

    /// Returns the poses.
    pub fn poses(&self) -> &[Stamped] {
        &self.poses
    }

    /// Returns the number of poses.
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// Returns whether there are no poses.
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// Returns the length of the way, in metres.
    pub fn way(&self) -> f64 {
        let step = |pair: &[Stamped]| crate::geometry::distance(pair[0].pose.position, pair[1].pose.position);
        self.poses.windows(2).map(step).sum()
    }

    /// Returns the poses of both trajectories that are less than `tolerance` seconds apart, each used once.
    ///
    /// # Errors
    /// `InvalidInput` when none are.
    pub fn associated(&self, other: &Self, tolerance: f64) -> Result<(Self, Self)> {
        let (mut own, mut its) = (Vec::new(), Vec::new());
        let mut rest = other.poses.as_slice();
        for stamped in &self.poses {
            let after = rest.partition_point(|other| other.time < stamped.time);
            let aside = |at: &usize| (rest[*at].time - stamped.time).abs();
            let near =
                [after.checked_sub(1), Some(after)].into_iter().flatten().filter(|at| *at < rest.len());
            let nearest = near.min_by(|a, b| aside(a).total_cmp(&aside(b)));
            if let Some(at) = nearest.filter(|at| aside(at) <= tolerance) {
                own.push(*stamped);
                its.push(rest[at]);
                rest = &rest[at + 1..];
            }
        }
        if own.is_empty() {
            return Err(Error::invalid_input(format!(
                "no poses of the trajectories are within {tolerance} s of each other; check that both use the same clock"
            )));
        }
        Ok((Self { poses: own }, Self { poses: its }))
    }

    /// Returns the trajectory moved, rotated and scaled.
    #[must_use]
    pub fn transformed(&self, by: &Similarity3) -> Self {
        let moved = |stamped: &Stamped| {
            let rotated = by.pose.then(&Pose { position: [0.0; 3], ..stamped.pose }).rotation;
            let pose = Pose { rotation: rotated, position: by.point(stamped.pose.position) };
            Stamped { pose, ..*stamped }
        };
        Self { poses: self.poses.iter().map(moved).collect() }
    }
}
