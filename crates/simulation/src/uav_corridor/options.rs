//! What can be chosen of the corridor.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

/// What can be chosen of each flight: when the environment is made, and by the options of a reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct CorridorOptions {
    /// Fewest obstacles.
    #[param(default = 2, range = 0..=15)]
    pub min_obstacles: u32,
    /// Most obstacles; OpenDR has at most five of each of its three shapes.
    #[param(default = 6, range = 0..=15)]
    pub max_obstacles: u32,
    /// How likely there are walls to both sides.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub walls: f32,
    /// Deviation of a measured depth, as a share of it.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub range_noise: f32,
    /// Share of pixels that measure nothing; they read as nothing within range (REP 117).
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub dropped_pixels: f32,
    /// Largest mean wind, with gusts of a third of it; moves a drone with dynamics only.
    #[param(default = 3.0, range = 0.0..=15.0, unit = "m/s")]
    pub wind: f32,
}

/// What an environment is made for.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct CorridorForm {
    /// OpenDR's seven choices instead of two numbers.
    #[param(default = false)]
    pub discrete: bool,
    /// A quadrotor with inertia, rotors that lag, drag and wind, instead of a body that goes where it is told.
    #[param(default = false)]
    pub dynamics: bool,
    /// One box instead of OpenDR's dictionary: depth as a share of the range, then the other numbers.
    #[param(default = false)]
    pub flat: bool,
    /// Also shows the offset from the middle of the corridor (m) and the yaw (rad), which OpenDR does not.
    #[param(default = false)]
    pub pose: bool,
}

/// What a user may set of `UavDepthCorridor-v1`.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct UavDepthCorridorParams {
    /// What a reset can choose too.
    #[param(flatten)]
    pub options: CorridorOptions,
    /// What stays.
    #[param(flatten)]
    pub form: CorridorForm,
}

impl CorridorOptions {
    /// Checks fields alone and together.
    pub(super) fn checked(self) -> Result<Self> {
        self.check()?;
        if self.min_obstacles > self.max_obstacles {
            return Err(Error::invalid_param(format!(
                "min_obstacles is {}, above max_obstacles, which is {}; exchange them or set both",
                self.min_obstacles, self.max_obstacles
            )));
        }
        Ok(self)
    }

    /// In the order of the fields.
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

    /// As [`Self::numbers`] writes them.
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
