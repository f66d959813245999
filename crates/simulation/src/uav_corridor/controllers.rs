//! Controllers without learning, to compare policies with and to build them on.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Result};

use super::{CorridorSight, SIDE, TURN};

/// Flies by what is seen, and by what it remembers of the flight.
pub trait CorridorController {
    /// Forgets the last flight.
    fn begin(&mut self);

    /// Heading and change of yaw, each within [-1, 1] as in `UavDepthCorridor-v1`.
    fn act(&mut self, sight: &CorridorSight) -> [f32; 2];

    /// Notes the action that was executed instead of the last one of [`act`](Self::act).
    fn executed(&mut self, action: [f32; 2]);

    /// The yaw that it keeps account of, before and after its last action.
    fn yaw_account(&self) -> YawAccount;

    /// Takes a yaw account over, e.g. from a snapshot.
    fn set_yaw_account(&mut self, account: YawAccount);
}

/// The yaw of a drone by its own actions, rad: before the last one and after it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct YawAccount {
    before: f32,
    now: f32,
}

/// A controller that reads observations: for evaluations, and where any [`Controller`] is taken.
#[derive(Debug, Clone)]
pub struct BySight<C> {
    controller: C,
    space: Space,
    sight: CorridorSight,
}

impl<C: CorridorController> BySight<C> {
    /// `controller`, for observations of `space`.
    pub fn new(controller: C, space: Space) -> Self {
        Self { controller, space, sight: CorridorSight::default() }
    }
}

impl<C: CorridorController> Controller for BySight<C> {
    fn reset(&mut self) {
        self.controller.begin();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.sight.read(&self.space, observation)?;
        let length = action.len();
        let action = action.as_mut_array().ok_or_else(|| {
            Error::invalid_input(format!("room for {length} numbers of an action; it has 2, heading and yaw"))
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
        self.controller.yaw_account().save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.controller.set_yaw_account(YawAccount::load(state)?);
        Ok(())
    }
}

/// Straight ahead, whatever comes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Straight;

/// By hand: towards the freest columns of the picture, near the bearing of the target.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reactive {
    yaw: YawAccount,
}

/// The sum of a pull towards the target and a push away from each column of the picture (Khatib, Real-time obstacle
/// avoidance for manipulators and mobile robots, 1986).
#[derive(Debug, Clone, Copy, Default)]
pub struct PotentialField {
    yaw: YawAccount,
}

/// Columns that are looked at together.
const BLOCK: usize = 4;
pub(super) const COLUMNS: usize = SIDE / BLOCK;
/// Rows in which an obstacle would be met.
const ROWS: std::ops::Range<usize> = 20..44;
const LARGEST: f32 = TURN as f32;

impl CorridorController for Straight {
    fn begin(&mut self) {}

    fn act(&mut self, _: &CorridorSight) -> [f32; 2] {
        [0.0; 2]
    }

    fn executed(&mut self, _: [f32; 2]) {}

    fn yaw_account(&self) -> YawAccount {
        YawAccount::default()
    }

    fn set_yaw_account(&mut self, _: YawAccount) {}
}

/// The part of a controller that keeps account of its yaw.
macro_rules! with_yaw_account {
    () => {
        fn begin(&mut self) {
            self.yaw = YawAccount::default();
        }

        fn executed(&mut self, action: [f32; 2]) {
            self.yaw.replace(action);
        }

        fn yaw_account(&self) -> YawAccount {
            self.yaw
        }

        fn set_yaw_account(&mut self, account: YawAccount) {
            self.yaw = account;
        }
    };
}

impl CorridorController for Reactive {
    with_yaw_account!();

    fn act(&mut self, sight: &CorridorSight) -> [f32; 2] {
        let (columns, wanted) = (columns(sight), bearing_of_target(sight));
        let (mut best, mut heading) = (f32::NEG_INFINITY, 0.0);
        for at in 0..COLUMNS {
            let free = free_width(&columns, bearing(at));
            let score = free.min(6.0) - 2.0 * (bearing(at) - wanted).abs();
            if score > best {
                (best, heading) = (score, bearing(at));
            }
        }
        let turn = if best < 2.5 {
            // Nothing is free ahead: look towards the middle of the corridor.
            if offset(sight, self.yaw.now) > 0.0 { -LARGEST } else { LARGEST }
        } else {
            (wanted + self.yaw.now).clamp(-0.4, 0.4) - self.yaw.now + 0.5 * heading
        };
        action(&mut self.yaw, heading, turn)
    }
}

impl CorridorController for PotentialField {
    with_yaw_account!();

    fn act(&mut self, sight: &CorridorSight) -> [f32; 2] {
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

/// Scales angles to an action, and keeps account of the yaw as the environment does.
fn action(yaw: &mut YawAccount, heading: f32, turn: f32) -> [f32; 2] {
    let action = [heading, turn].map(|angle| (angle / LARGEST).clamp(-1.0, 1.0));
    yaw.before = yaw.now;
    yaw.replace(action);
    action
}

impl YawAccount {
    /// The last action was this one.
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

/// The smallest depth in each block of columns.
pub(super) fn columns(sight: &CorridorSight) -> [f32; COLUMNS] {
    let mut columns = [f32::INFINITY; COLUMNS];
    for row in ROWS {
        for (at, depth) in sight.depths[row * SIDE..(row + 1) * SIDE].iter().enumerate() {
            columns[at / BLOCK] = columns[at / BLOCK].min(*depth);
        }
    }
    columns
}

/// Makes [`columns`] of `sight` those of `shares`, shares of the range of the camera.
pub(super) fn spread_columns(shares: &[f32; COLUMNS], sight: &mut CorridorSight) {
    for row in ROWS {
        for (at, depth) in sight.depths[row * SIDE..(row + 1) * SIDE].iter_mut().enumerate() {
            *depth = shares[at / BLOCK] * super::RANGE;
        }
    }
}

/// How far to the left the middle of a block of columns lies, radians.
fn bearing(column: usize) -> f32 {
    (super::HALF_WIDTH * (1.0 - 2.0 * (column as f32 + 0.5) / COLUMNS as f32)).atan()
}

/// How far the drone could fly in this direction with 0.6 m to either side.
fn free_width(columns: &[f32; COLUMNS], heading: f32) -> f32 {
    let in_the_way = |at: usize| (bearing(at) - heading).abs().sin() * columns[at] < 0.6;
    let nearest = (0..COLUMNS).filter(|at| in_the_way(*at)).map(|at| columns[at]);
    nearest.fold(super::RANGE, f32::min)
}

fn bearing_of_target(sight: &CorridorSight) -> f32 {
    sight.target[1].atan2(sight.target[0])
}

/// How far to the left of the corridor's middle the drone is.
fn offset(sight: &CorridorSight, yaw: f32) -> f32 {
    let (sine, cosine) = yaw.sin_cos();
    -(sine * sight.target[0] + cosine * sight.target[1])
}
