//! Parameters of the environment, each of which a reset can change.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

use super::CONTROL_PERIOD;

opendr_engine::choices! {
    /// Form of the reference path.
    pub enum ReferencePath {
        /// A horizontal eight whose height rises and falls slowly.
        FigureEight = "figure_eight",
        /// A horizontal circle.
        Circle = "circle",
        /// A point.
        Hover = "hover",
    }
}

/// Parameters of `QuadTrack-v1`, and options of its reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct QuadTrackParams {
    /// Reference path; its size, phase, direction and exact speed are drawn for each episode.
    #[param(default = ReferencePath::FigureEight)]
    pub reference: ReferencePath,
    /// Mean angular speed of the reference; each episode has 0.85 to 1.15 times as much.
    #[param(default = 0.75, range = 0.1..=2.0, unit = "rad/s")]
    pub speed: f64,
    /// Length of an episode.
    #[param(default = 60.0, range = 0.1..=3600.0, unit = "s")]
    pub duration: f64,
    /// Time from which the plant is changed.
    #[param(default = 20.0, range = 0.0..=3600.0, unit = "s")]
    pub change_at: f64,
    /// Mass after the change, as a factor of the nominal 1.5 kg.
    #[param(default = 1.0, range = 0.5..=1.8)]
    pub mass_factor: f64,
    /// Drag after the change, as a factor.
    #[param(default = 1.0, range = 0.0..=10.0)]
    pub drag_factor: f64,
    /// Mean wind after the change, horizontal and of random direction, with Dryden turbulence of that wind.
    #[param(default = 0.0, range = 0.0..=12.0, unit = "m/s")]
    pub wind: f64,
    /// Mean wind before the change, in the same direction.
    #[param(default = 0.5, range = 0.0..=12.0, unit = "m/s")]
    pub breeze: f64,
    /// Intensity of the turbulence, as a factor of MIL-F-8785C's.
    #[param(default = 1.0, range = 0.0..=3.0)]
    pub turbulence: f64,
    /// Share of its thrust that one random motor loses at the change.
    #[param(default = 0.0, range = 0.0..=0.5)]
    pub motor_loss: f64,
    /// Time constant of the rotors.
    #[param(default = 0.04, range = 0.01..=0.2, unit = "s")]
    pub rotor_lag: f64,
    /// Time from a command to the attitude controller.
    #[param(default = 0.015, range = 0.0..=0.1, unit = "s")]
    pub actuation_delay: f64,
    /// Age of the measurements behind a state estimate, which extrapolates them at constant velocity.
    #[param(default = 0.02, range = 0.0..=0.1, unit = "s")]
    pub estimate_delay: f64,
    /// Deviation of an estimated position, independent from step to step.
    #[param(default = 0.015, range = 0.0..=0.2, unit = "m")]
    pub position_noise: f64,
    /// Deviation of a slow error of the estimated position (first order, 2 s).
    #[param(default = 0.005, range = 0.0..=0.2, unit = "m")]
    pub position_drift: f64,
    /// Deviation of an estimated velocity, independent from step to step.
    #[param(default = 0.05, range = 0.0..=1.0, unit = "m/s")]
    pub velocity_noise: f64,
    /// How often measurements fail, for 0.1 to 0.3 s each; the estimate is extrapolated meanwhile.
    #[param(default = 0.1, range = 0.0..=2.0, unit = "1/s")]
    pub dropouts: f64,
}

impl QuadTrackParams {
    /// Checks fields alone and together.
    pub(super) fn checked(self) -> Result<Self> {
        self.check()?;
        if self.mass_factor > 1.6 && self.motor_loss > 0.3 {
            return Err(Error::invalid_param(format!(
                "a mass of {} times the nominal with a motor that loses {} of its thrust cannot hover; lower one",
                self.mass_factor, self.motor_loss
            )));
        }
        Ok(self)
    }

    /// Steps of an episode.
    pub(super) fn steps(&self) -> u64 {
        (self.duration / CONTROL_PERIOD).round() as u64
    }

    /// In the order of the fields.
    pub(super) fn numbers(&self) -> [f64; 17] {
        let reference = match self.reference {
            ReferencePath::FigureEight => 0.0,
            ReferencePath::Circle => 1.0,
            ReferencePath::Hover => 2.0,
        };
        [
            reference,
            self.speed,
            self.duration,
            self.change_at,
            self.mass_factor,
            self.drag_factor,
            self.wind,
            self.breeze,
            self.turbulence,
            self.motor_loss,
            self.rotor_lag,
            self.actuation_delay,
            self.estimate_delay,
            self.position_noise,
            self.position_drift,
            self.velocity_noise,
            self.dropouts,
        ]
    }

    /// From what [`Self::numbers`] returns.
    pub(super) fn from_numbers(numbers: [f64; 17]) -> Result<Self> {
        let [reference, speed, duration, change_at, mass_factor, drag_factor, wind, breeze, turbulence, ..] =
            numbers;
        let [
            ..,
            motor_loss,
            rotor_lag,
            actuation_delay,
            estimate_delay,
            noise,
            drift,
            velocity_noise,
            dropouts,
        ] = numbers;
        let params = Self {
            reference: match reference {
                1.0 => ReferencePath::Circle,
                2.0 => ReferencePath::Hover,
                _ => ReferencePath::FigureEight,
            },
            speed,
            duration,
            change_at,
            mass_factor,
            drag_factor,
            wind,
            breeze,
            turbulence,
            motor_loss,
            rotor_lag,
            actuation_delay,
            estimate_delay,
            position_noise: noise,
            position_drift: drift,
            velocity_noise,
            dropouts,
        };
        params.checked()
    }
}
