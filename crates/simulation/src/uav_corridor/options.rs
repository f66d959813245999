//! Parameters of the corridor.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

/// Options of each flight, set at construction or by the options of a reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct CorridorOptions {
    /// Minimum number of obstacles.
    #[param(default = 2, range = 0..=15)]
    pub min_obstacles: u32,
    /// Maximum number of obstacles; OpenDR has at most five of each of its three shapes.
    #[param(default = 6, range = 0..=15)]
    pub max_obstacles: u32,
    /// Probability of walls on both sides.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub walls: f32,
    /// Standard deviation of a measured depth, as a fraction of it.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub range_noise: f32,
    /// Fraction of pixels without a measurement; they read as out of range (REP 117).
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub dropped_pixels: f32,
    /// Maximum mean wind, with gusts of a third of it; it affects only a drone with dynamics.
    #[param(default = 3.0, range = 0.0..=15.0, unit = "m/s")]
    pub wind: f32,
}

/// Spaces and dynamics of an environment, fixed at construction.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct CorridorForm {
    /// Uses OpenDR's seven discrete actions instead of two numbers.
    #[param(default = false)]
    pub discrete: bool,
    /// Simulates a quadrotor with inertia, rotor lag, drag and wind, instead of moving it to each commanded position.
    #[param(default = false)]
    pub dynamics: bool,
    /// Uses one box instead of OpenDR's dictionary: depth as a fraction of the range, then the other numbers.
    #[param(default = false)]
    pub flat: bool,
    /// Adds the offset from the middle of the corridor (m) and the yaw (rad) to the observation; OpenDR has neither.
    #[param(default = false)]
    pub pose: bool,
}

/// Parameters of `UavDepthCorridor-v1`.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct UavDepthCorridorParams {
    /// Options that a reset can change.
    #[param(flatten)]
    pub options: CorridorOptions,
    /// Spaces and dynamics.
    #[param(flatten)]
    pub form: CorridorForm,
}

impl CorridorOptions {
    /// Checks each field, and the fields together.
    pub(super) fn checked(self) -> Result<Self> {
        self.check()?;
        if self.min_obstacles > self.max_obstacles {
            return Err(Error::invalid_param(format!(
                "min_obstacles is {}, greater than max_obstacles = {}; swap them or set both",
                self.min_obstacles, self.max_obstacles
            )));
        }
        Ok(self)
    }

    /// Returns the fields as numbers, in their order.
    pub(super) fn numbers(&self) -> [f64; 6] {
        [
            f64::from(self.min_obstacles),
            f64::from(self.max_obstacles),
            f64::from(self.walls),
            f64::from(self.range_noise),
            f64::from(self.dropped_pixels),
            f64::from(self.wind),
        ]
    }

    /// Reads what [`Self::numbers`] returns.
    pub(super) fn of_numbers(numbers: [f64; 6]) -> Result<Self> {
        let [fewest, most, walls, noise, dropped, wind] = numbers;
        let options = Self {
            min_obstacles: fewest as u32,
            max_obstacles: most as u32,
            walls: walls as f32,
            range_noise: noise as f32,
            dropped_pixels: dropped as f32,
            wind: wind as f32,
        };
        options.checked()
    }
}
