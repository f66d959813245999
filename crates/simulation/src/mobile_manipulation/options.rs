//! Parameters of the environments.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

opendr_engine::choices! {
    /// Drive of the base.
    pub enum BaseKind {
        /// Moves in all directions; actions are turn rate, speed ahead and speed to the left.
        Omni = "omni",
        /// Differential drive; actions are speed ahead and turn rate.
        Diff = "diff",
    }
}

opendr_engine::choices! {
    /// How actions move the base.
    pub enum Strategy {
        /// Actions are the velocities of the base.
        Dirvel = "dirvel",
        /// Actions are added to the planned velocity of the gripper; large actions cost.
        Relvelm = "relvelm",
        /// As `relvelm`; turning and speed of the base cost.
        Relveld = "relveld",
    }
}

/// Parameters of the environments, and options of their reset except for `base` and `learn_speed`, which change the actions.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MobileManipulationParams {
    /// Drive of the base.
    #[param(default = BaseKind::Omni)]
    pub base: BaseKind,
    /// How actions move the base.
    #[param(default = Strategy::Relvelm)]
    pub strategy: Strategy,
    /// Whether the first action is the speed of the gripper, from 0.01 m/s at -1 to 0.1 m/s at 1, as in N2M2 (Honerkamp,
    /// Welschehold and Valada, 2023).
    #[param(default = false)]
    pub learn_speed: bool,
    /// Cost of each m/s below the largest speed of the gripper, if its speed is an action.
    #[param(default = 0.5, range = 0.0..=100.0)]
    pub speed_cost: f64,
    /// Cost of a squared action.
    #[param(default = 0.01, range = 0.0..=10.0)]
    pub action_cost: f64,
    /// Failures of the inverse kinematics after which an episode terminates. OpenDR trains with 20 and evaluates with 100.
    #[param(default = 100, range = 1..=100_000)]
    pub ik_fail_limit: u32,
    /// Standard deviation of the noise on the motion of the base in a step, in metres and radians. OpenDR trains with 0.015.
    #[param(default = 0.0, range = 0.0..=0.1)]
    pub base_noise: f64,
}

impl MobileManipulationParams {
    /// Checks fields alone.
    pub(super) fn checked(self) -> Result<Self> {
        self.check()?;
        Ok(self)
    }

    /// Returns the fields as numbers, in their order.
    pub(super) fn numbers(&self) -> [f64; 7] {
        let strategy = match self.strategy {
            Strategy::Dirvel => 0.0,
            Strategy::Relvelm => 1.0,
            Strategy::Relveld => 2.0,
        };
        [
            f64::from(u8::from(self.base == BaseKind::Diff)),
            strategy,
            f64::from(u8::from(self.learn_speed)),
            self.speed_cost,
            self.action_cost,
            f64::from(self.ik_fail_limit),
            self.base_noise,
        ]
    }

    /// Creates the parameters from what [`Self::numbers`] returns.
    ///
    /// # Errors
    /// `InvalidParam` for a number out of range.
    pub(super) fn from_numbers(numbers: [f64; 7]) -> Result<Self> {
        let [base, strategy, learn_speed, speed_cost, action_cost, ik_fail_limit, base_noise] = numbers;
        let strategy = match strategy {
            0.0 => Strategy::Dirvel,
            1.0 => Strategy::Relvelm,
            2.0 => Strategy::Relveld,
            other => return Err(Error::invalid_param(format!("no strategy {other}"))),
        };
        let base = if base == 0.0 { BaseKind::Omni } else { BaseKind::Diff };
        let params = Self {
            base,
            strategy,
            learn_speed: learn_speed != 0.0,
            speed_cost,
            action_cost,
            ik_fail_limit: ik_fail_limit as u32,
            base_noise,
        };
        params.checked()
    }

    /// Returns the number of actions.
    pub(super) fn actions(&self) -> usize {
        let base = match self.base {
            BaseKind::Omni => 3,
            BaseKind::Diff => 2,
        };
        base + usize::from(self.learn_speed)
    }
}
