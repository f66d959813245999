//! Planned motions of the gripper.

use super::{CONTROL_PERIOD, GRIPPER_SPEEDS, TOLERANCES};
use crate::kinematics::Transform;
use crate::multirotor::{dot, minus, plus};

/// A motion from one pose to another, by the length of the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Motion {
    start: Transform,
    pub goal: Transform,
    /// Hinge of an arc and its angle in radians, to the left if positive; none for a line.
    arc: Option<([f64; 2], f64)>,
    length: f64,
    travelled: f64,
}

/// Where a motion leads; it begins where the gripper is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Goal {
    /// On a line, turning as it goes.
    Line(Transform),
    /// From a pose about a vertical hinge at x, y, by an angle.
    Arc { from: Transform, hinge: [f64; 2], angle: f64 },
}

impl Motion {
    /// Begins the motion to a goal.
    pub fn begin(gripper: Transform, goal: Goal) -> Self {
        let motion = match goal {
            Goal::Line(goal) => {
                let way = minus(goal.position, gripper.position, 1.0);
                Self { start: gripper, goal, arc: None, length: dot(way, way).sqrt(), travelled: 0.0 }
            }
            Goal::Arc { from, hinge, angle } => {
                let [x, y] = [from.position[0] - hinge[0], from.position[1] - hinge[1]];
                let length = angle.abs() * (x * x + y * y).sqrt();
                Self { start: from, goal: from, arc: Some((hinge, angle)), length, travelled: 0.0 }
            }
        };
        Self { goal: motion.at(motion.length), ..motion }.with_exact_goal(goal)
    }

    fn with_exact_goal(self, goal: Goal) -> Self {
        match goal {
            Goal::Line(goal) => Self { goal, ..self },
            Goal::Arc { .. } => self,
        }
    }

    /// Returns the pose after a part of the way.
    fn at(&self, travelled: f64) -> Transform {
        let share = if self.length > 1e-9 { (travelled / self.length).clamp(0.0, 1.0) } else { 1.0 };
        match self.arc {
            None => Transform {
                position: plus(
                    self.start.position,
                    minus(self.goal.position, self.start.position, 1.0),
                    share,
                ),
                rotation: self.start.rotation_towards(&self.goal, share),
            },
            Some(([x, y], angle)) => {
                let hinge = Transform::at([x, y, 0.0]);
                let turn = Transform::about([0.0, 0.0, 1.0], share * angle);
                hinge.then(&turn).then(&hinge.relative(&self.start))
            }
        }
    }

    /// Returns the length of the way after a step: a hundredth of the rest within the limits of the speed, or at `speed`, m/s.
    fn after_step(&self, speed: Option<f64>) -> f64 {
        let [slowest, fastest] = GRIPPER_SPEEDS.map(|speed| speed * CONTROL_PERIOD);
        let rest = self.length - self.travelled;
        let step =
            speed.map_or_else(|| (rest / 100.0).clamp(slowest, fastest), |speed| speed * CONTROL_PERIOD);
        self.travelled + step.min(rest)
    }

    /// Returns the next pose.
    pub fn next(&self) -> Transform {
        self.at(self.after_step(None))
    }

    /// Takes a step and returns the pose.
    pub fn advance(&mut self, speed: Option<f64>) -> Transform {
        self.travelled = self.after_step(speed);
        self.now()
    }

    /// Returns the present pose of the plan.
    pub fn now(&self) -> Transform {
        self.at(self.travelled)
    }

    /// Returns whether the gripper has reached the goal.
    pub fn is_reached(&self, gripper: &Transform) -> bool {
        let away = minus(self.goal.position, gripper.position, 1.0);
        dot(away, away).sqrt() < TOLERANCES[0] && gripper.angle_to(&self.goal) < TOLERANCES[1]
    }

    /// Returns the poses of the way, for drawings.
    pub fn way(&self) -> impl Iterator<Item = Transform> {
        (0..=24).map(|part| self.at(self.length * f64::from(part) / 24.0))
    }

    /// Returns how far the plan has come, for a snapshot.
    pub fn progress(&self) -> (Transform, f64) {
        (self.start, self.travelled)
    }

    /// Sets how far the plan has come.
    #[must_use]
    pub fn resumed(self, travelled: f64) -> Self {
        Self { travelled, ..self }
    }
}
