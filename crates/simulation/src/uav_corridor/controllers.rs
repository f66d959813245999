//! Hand-written controllers, as baselines for policies.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Result};

use super::{CorridorObservation, SIDE, TURN};

/// A controller that acts on the current observation and on its own state.
pub trait CorridorController {
    /// Resets the controller for a new flight.
    fn begin(&mut self);

    /// Returns heading and change of yaw, each in [-1, 1] as in `UavDepthCorridor-v1`.
    fn act(&mut self, sight: &CorridorObservation) -> [f32; 2];

    /// Replaces the last action of [`act`](Self::act) by the executed one.
    fn executed(&mut self, action: [f32; 2]);

    /// Returns the yaw estimate.
    fn yaw_tracker(&self) -> YawTracker;

    /// Sets the yaw estimate, e.g. from a snapshot.
    fn set_yaw_tracker(&mut self, account: YawTracker);
}

/// Yaw of the drone integrated from the actions, in radians, before and after the last action.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct YawTracker {
    before: f32,
    now: f32,
}

/// Adapts a [`CorridorController`] to raw observations, as a [`Controller`].
#[derive(Debug, Clone)]
pub struct ObservationController<C> {
    controller: C,
    space: Space,
    sight: CorridorObservation,
}

impl<C: CorridorController> ObservationController<C> {
    /// Wraps a controller for observations of `space`.
    pub fn new(controller: C, space: Space) -> Self {
        Self { controller, space, sight: CorridorObservation::default() }
    }
}

impl<C> AsMut<C> for ObservationController<C> {
    fn as_mut(&mut self) -> &mut C {
        &mut self.controller
    }
}

impl<C: CorridorController> Controller for ObservationController<C> {
    fn reset(&mut self) {
        self.controller.begin();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.sight.read(&self.space, observation)?;
        let length = action.len();
        let action = action.as_mut_array().ok_or_else(|| {
            Error::invalid_input(format!(
                "the buffer of the action has {length} numbers; give 2, heading and yaw"
            ))
        })?;
        *action = self.controller.act(&self.sight);
        Ok(())
    }

    fn executed(&mut self, action: &[f32]) {
        if let Some(action) = action.as_array() {
            self.controller.executed(*action);
        }
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.controller.yaw_tracker().save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.controller.set_yaw_tracker(YawTracker::load(state)?);
        Ok(())
    }
}

/// Flies straight ahead.
#[derive(Debug, Clone, Copy, Default)]
pub struct StraightController;

/// Flies towards the free columns of the depth image nearest to the target's bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReactiveController {
    yaw: YawTracker,
    share: f32,
    /// Angle to the left of the target that it flies to, in radians, and cost of a radian away from it, in metres of free distance.
    aside: f32,
    detour: f32,
}

/// Cost of a radian away from the target, in metres of free distance.
const DETOUR: f32 = 2.0;

impl Default for ReactiveController {
    fn default() -> Self {
        Self { yaw: YawTracker::default(), share: 1.0, aside: 0.0, detour: DETOUR }
    }
}

impl ReactiveController {
    /// Creates one that flies only this share of its headings, for measurements of what a weak controller is worth.
    #[must_use]
    pub fn with_heading_share(share: f32) -> Self {
        Self { share, ..Self::default() }
    }

    /// Follows a command from now on, each number in [-1, 1]: a reference, the angle to the left of the target, up to 45 degrees; and a
    /// gain, the logarithm to the base 4 of the cost of detours. Zeros are the controller without commands.
    pub fn follow(&mut self, [aside, detour]: [f32; 2]) {
        self.aside = aside.clamp(-1.0, 1.0) * 2.0 * LARGEST;
        self.detour = DETOUR * 4.0_f32.powf(detour.clamp(-1.0, 1.0));
    }
}

/// Pure pursuit of the target on the middle line of the corridor (Coulter, Implementation of the pure pursuit path tracking algorithm,
/// 1992). It avoids no obstacle.
#[derive(Debug, Clone, Copy, Default)]
pub struct PurePursuit {
    yaw: YawTracker,
}

/// Potential field: attraction to the target and repulsion from each column of the depth image (Khatib, Real-time obstacle
/// avoidance for manipulators and mobile robots, 1986).
#[derive(Debug, Clone, Copy, Default)]
pub struct PotentialField {
    yaw: YawTracker,
}

/// Columns that are processed together.
const BLOCK: usize = 4;
pub(super) const COLUMNS: usize = SIDE / BLOCK;
/// Rows at the height of the flight.
const ROWS: std::ops::Range<usize> = 20..44;
const LARGEST: f32 = TURN as f32;

impl CorridorController for StraightController {
    fn begin(&mut self) {}

    fn act(&mut self, _: &CorridorObservation) -> [f32; 2] {
        [0.0; 2]
    }

    fn executed(&mut self, _: [f32; 2]) {}

    fn yaw_tracker(&self) -> YawTracker {
        YawTracker::default()
    }

    fn set_yaw_tracker(&mut self, _: YawTracker) {}
}

/// The methods of a controller with a [`YawTracker`].
macro_rules! with_yaw_tracker {
    () => {
        fn begin(&mut self) {
            self.yaw = YawTracker::default();
        }

        fn executed(&mut self, action: [f32; 2]) {
            self.yaw.replace(action);
        }

        fn yaw_tracker(&self) -> YawTracker {
            self.yaw
        }

        fn set_yaw_tracker(&mut self, account: YawTracker) {
            self.yaw = account;
        }
    };
}

impl CorridorController for ReactiveController {
    with_yaw_tracker!();

    fn act(&mut self, sight: &CorridorObservation) -> [f32; 2] {
        let (columns, wanted) = (columns(sight), bearing_of_target(sight) + self.aside);
        let (mut best, mut heading) = (f32::NEG_INFINITY, 0.0);
        for at in 0..COLUMNS {
            let free = free_width(&columns, bearing(at));
            let score = free.min(6.0) - self.detour * (bearing(at) - wanted).abs();
            if score > best {
                (best, heading) = (score, bearing(at));
            }
        }
        let turn = if best < 2.5 {
            // Nothing is free ahead: turn towards the middle of the corridor.
            if offset(sight, self.yaw.now) > 0.0 { -LARGEST } else { LARGEST }
        } else {
            (wanted + self.yaw.now).clamp(-0.4, 0.4) - self.yaw.now + 0.5 * heading
        };
        let [heading, turn] = action(&mut self.yaw, heading, turn);
        [self.share * heading, turn]
    }
}

impl CorridorController for PurePursuit {
    with_yaw_tracker!();

    fn act(&mut self, sight: &CorridorObservation) -> [f32; 2] {
        let [ahead, left, _] = sight.target;
        let curvature = 2.0 * left / (ahead * ahead + left * left).max(1e-6);
        // The chord of a metre of the arc, then its change of direction.
        action(&mut self.yaw, 0.5 * curvature, curvature)
    }
}

impl CorridorController for PotentialField {
    with_yaw_tracker!();

    fn act(&mut self, sight: &CorridorObservation) -> [f32; 2] {
        const REACH: f32 = 5.0;
        const PUSH: f32 = 1.2;
        let (sine, cosine) = bearing_of_target(sight).sin_cos();
        let mut force = [cosine, sine];
        for (at, depth) in columns(sight).into_iter().enumerate() {
            let near = depth.clamp(0.3, REACH);
            let push = PUSH * (1.0 / near - 1.0 / REACH) / near;
            let (sine, cosine) = bearing(at).sin_cos();
            force = [force[0] - push * cosine, force[1] - push * sine];
        }
        let heading = force[1].atan2(force[0]).clamp(-LARGEST, LARGEST);
        let ahead = (bearing_of_target(sight) + self.yaw.now).clamp(-0.4, 0.4);
        let turn = ahead - self.yaw.now + 0.5 * heading;
        action(&mut self.yaw, heading, turn)
    }
}

/// Scales angles to an action, and tracks the yaw as the environment does.
fn action(yaw: &mut YawTracker, heading: f32, turn: f32) -> [f32; 2] {
    let action = [heading, turn].map(|angle| (angle / LARGEST).clamp(-1.0, 1.0));
    yaw.before = yaw.now;
    yaw.replace(action);
    action
}

impl YawTracker {
    /// Replaces the last action.
    fn replace(&mut self, [_, turn]: [f32; 2]) {
        let right_angle = std::f32::consts::FRAC_PI_2;
        self.now = (self.before + turn.clamp(-1.0, 1.0) * LARGEST).clamp(-right_angle, right_angle);
    }

    pub(super) fn save(self, snapshot: &mut Snapshot) {
        snapshot.extend_numbers([self.before, self.now].map(f64::from));
    }

    pub(super) fn load(state: &mut StateReader<'_>) -> Result<Self> {
        Ok(Self { before: state.finite()? as f32, now: state.finite()? as f32 })
    }
}

/// Returns the smallest depth in each block of columns.
pub(super) fn columns(sight: &CorridorObservation) -> [f32; COLUMNS] {
    let mut columns = [f32::INFINITY; COLUMNS];
    for row in ROWS {
        for (at, depth) in sight.depths[row * SIDE..(row + 1) * SIDE].iter().enumerate() {
            columns[at / BLOCK] = columns[at / BLOCK].min(*depth);
        }
    }
    columns
}

/// Fills `sight` such that [`columns`] returns `shares` times the range of the camera.
pub(super) fn spread_columns(shares: &[f32; COLUMNS], sight: &mut CorridorObservation) {
    for row in ROWS {
        for (at, depth) in sight.depths[row * SIDE..(row + 1) * SIDE].iter_mut().enumerate() {
            *depth = shares[at / BLOCK] * super::RANGE;
        }
    }
}

/// Returns the bearing of the middle of a block of columns, in radians to the left.
pub(super) fn bearing(column: usize) -> f32 {
    (super::HALF_WIDTH * (1.0 - 2.0 * (column as f32 + 0.5) / COLUMNS as f32)).atan()
}

/// Returns the free distance in a direction, with 0.6 m to either side.
fn free_width(columns: &[f32; COLUMNS], heading: f32) -> f32 {
    let in_the_way = |at: usize| (bearing(at) - heading).abs().sin() * columns[at] < 0.6;
    let nearest = (0..COLUMNS).filter(|at| in_the_way(*at)).map(|at| columns[at]);
    nearest.fold(super::RANGE, f32::min)
}

fn bearing_of_target(sight: &CorridorObservation) -> f32 {
    sight.target[1].atan2(sight.target[0])
}

/// Returns the offset of the drone from the middle of the corridor, to the left.
fn offset(sight: &CorridorObservation, yaw: f32) -> f32 {
    let (sine, cosine) = yaw.sin_cos();
    -(sine * sight.target[0] + cosine * sight.target[1])
}
