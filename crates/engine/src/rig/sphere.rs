//! Movement on a sphere, for all rigs.

use super::axis::TICKS;
use super::{Achieved, Limit, ViewAxis, ViewPose};
use crate::target::{Action, ActionBase as _};
use crate::{Error, Result};

/// Axes with a position on each: what a rig moves by.
///
/// Positions are whole ticks. Movements therefore compose exactly: an action and its opposite lead back to the same pose bit
/// for bit, and the order of movements does not matter where no limit is met.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewSphere {
    axes: Vec<ViewAxis>,
    ticks: [i64; 4],
    /// The pose of axes that the rig has not.
    fixed: ViewPose,
}

impl ViewSphere {
    /// Creates a sphere of these axes that begins at `pose`, or at the nearest limits.
    ///
    /// # Errors
    /// `InvalidParam` when there are not 1 to 4 axes, or one of them has no room or no step.
    pub fn new(axes: Vec<ViewAxis>, pose: ViewPose) -> Result<Self> {
        if axes.is_empty() || axes.len() > 4 {
            return Err(Error::invalid_param(format!("a rig of {} axes; give 1 to 4", axes.len())));
        }
        axes.iter().try_for_each(ViewAxis::check)?;
        let mut sphere = Self { axes, ticks: [0; 4], fixed: pose };
        sphere.place(pose)?;
        Ok(sphere)
    }

    /// Creates a camera on a free sphere: azimuth round by 35 degrees, elevation by 17 between -52 and 52 degrees, distance by 0.7 closer
    /// between 2.7 and 4.5 radii of the subject.
    ///
    /// # Errors
    /// None.
    pub fn camera(pose: ViewPose) -> Result<Self> {
        let axes = vec![
            ViewAxis::turning("azimuth", 35f64.to_radians()),
            ViewAxis::limited("elevation", 17f64.to_radians(), -0.9, 0.9),
            ViewAxis::limited("distance", -0.7, 2.7, 4.5),
        ];
        Self::new(axes, pose)
    }

    /// Creates a drone around its subject: as [`Self::camera`], never from below, distances in metres.
    ///
    /// # Errors
    /// `InvalidParam` when the nearest distance is not below the farthest, or one is not positive.
    pub fn drone([nearest, farthest]: [f64; 2], pose: ViewPose) -> Result<Self> {
        Self::around(
            [nearest, farthest],
            vec![ViewAxis::turning("azimuth", 35f64.to_radians())],
            [0.0, 1.2],
            pose,
        )
    }

    /// Creates a camera at the wrist of an arm whose base stands before the subject: it reaches `half_turn` rad to either side,
    /// distances in metres.
    ///
    /// # Errors
    /// As [`Self::drone`].
    pub fn wrist_camera(half_turn: f64, [nearest, farthest]: [f64; 2], pose: ViewPose) -> Result<Self> {
        let azimuth = ViewAxis::limited("azimuth", 20f64.to_radians(), -half_turn, half_turn);
        Self::around([nearest, farthest], vec![azimuth], [-0.2, 1.2], pose)
    }

    fn around(
        [nearest, farthest]: [f64; 2],
        mut axes: Vec<ViewAxis>,
        [lowest, highest]: [f64; 2],
        pose: ViewPose,
    ) -> Result<Self> {
        if nearest.is_nan() || nearest <= 0.0 {
            return Err(Error::invalid_param(format!(
                "a nearest distance of {nearest}; give a positive one"
            )));
        }
        axes.push(ViewAxis::limited("elevation", 17f64.to_radians(), lowest, highest));
        axes.push(ViewAxis::limited("distance", -0.25 * (farthest - nearest), nearest, farthest));
        Self::new(axes, pose)
    }

    /// Returns the axes.
    pub fn axes(&self) -> &[ViewAxis] {
        &self.axes
    }

    /// Returns the pose of the ticks.
    pub fn pose(&self) -> ViewPose {
        let mut pose = self.fixed;
        let places = [&mut pose.azimuth, &mut pose.elevation, &mut pose.distance, &mut pose.fourth];
        for (place, (axis, tick)) in places.into_iter().zip(self.axes.iter().zip(self.ticks)) {
            *place = axis.position(tick);
        }
        pose
    }

    /// Moves to the tick nearest to a pose, or to the nearest limit.
    ///
    /// # Errors
    /// `InvalidInput` for numbers that are not finite.
    pub fn place(&mut self, pose: ViewPose) -> Result<()> {
        let wanted = [pose.azimuth, pose.elevation, pose.distance, pose.fourth];
        if wanted.iter().any(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "{pose:?} is no place on a sphere; give finite numbers"
            )));
        }
        self.fixed = pose;
        for ((axis, tick), wanted) in self.axes.iter().zip(&mut self.ticks).zip(wanted) {
            *tick = match axis.wraps {
                true => axis.tick_at(wanted).rem_euclid(TICKS),
                false => axis.tick_at(wanted.clamp(axis.low, axis.high)),
            };
        }
        Ok(())
    }

    /// Moves by an action.
    ///
    /// # Errors
    /// `InvalidInput` when the action has another number of axes.
    pub fn apply(&mut self, action: &Action) -> Result<Achieved> {
        let wanted = action.axes();
        if wanted.len() != self.axes.len() {
            let names: Vec<_> = self.axes.iter().map(|axis| axis.name.as_str()).collect();
            return Err(Error::invalid_input(format!(
                "an action of {} axes for a rig with {}: give one number each for {}",
                wanted.len(),
                self.axes.len(),
                names.join(", ")
            )));
        }
        let (mut moved, mut limits) = ([0.0; 4], [None; 4]);
        for (at, (axis, deflection)) in self.axes.iter().zip(wanted).enumerate() {
            let goal = self.ticks[at] + axis.ticks_of(*deflection);
            let reached = if axis.wraps { goal } else { goal.clamp(0, TICKS) };
            limits[at] = match reached.cmp(&goal) {
                std::cmp::Ordering::Less => Some(Limit::High),
                std::cmp::Ordering::Greater => Some(Limit::Low),
                std::cmp::Ordering::Equal => None,
            };
            moved[at] = match limits[at] {
                None => *deflection,
                Some(_) => axis.deflection_of(reached - self.ticks[at]),
            };
            self.ticks[at] = if axis.wraps { reached.rem_euclid(TICKS) } else { reached };
        }
        let action = Action::new(&moved[..wanted.len()])?;
        Ok(Achieved { action, pose: self.pose(), limits })
    }
}
