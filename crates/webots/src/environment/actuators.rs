//! Motors as actions.

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

use super::options::names;
use crate::kind::DeviceKind;
use crate::link::{MotorCommand, RobotInfo, WebotsLink};

/// What an action commands.
#[derive(Debug, Clone, Copy)]
enum Control {
    Position,
    Velocity,
    Force,
}

/// The motors of an action, in order.
#[derive(Debug, Clone)]
pub(super) struct Actuators {
    motors: Vec<(usize, Control)>,
}

impl Actuators {
    /// Selects the motors in `list`; all, by velocity, if it is empty.
    pub fn select(robot: &RobotInfo, list: &str) -> Result<Self> {
        let mut motors = names(list).map(|entry| one(robot, entry)).collect::<Result<Vec<_>>>()?;
        if motors.is_empty() {
            let is_motor = |kind: Option<DeviceKind>| kind.is_some_and(DeviceKind::is_motor);
            let all = robot.devices.iter().enumerate().filter(|(_, device)| is_motor(device.kind));
            motors = all.map(|(index, _)| (index, Control::Velocity)).collect();
        }
        for (at, (motor, _)) in motors.iter().enumerate() {
            if motors[..at].iter().any(|(other, _)| other == motor) {
                return Err(Error::invalid_param(format!(
                    "motor {:?} is named twice",
                    robot.devices[*motor].name
                )));
            }
        }
        if motors.is_empty() {
            return Err(Error::unsupported(format!("robot {:?} has no motors to act with", robot.name)));
        }
        Ok(Self { motors })
    }

    /// Returns the space of actions: one number for each motor.
    pub fn space(&self, robot: &RobotInfo) -> Result<Space> {
        let bounds = self.motors.iter().map(|(motor, control)| {
            let device = &robot.devices[*motor];
            match control {
                // Webots states equal limits for a motor without limits.
                Control::Position if device.range.0 < device.range.1 => device.range,
                Control::Position => (f64::NEG_INFINITY, f64::INFINITY),
                Control::Velocity => (-device.max_velocity, device.max_velocity),
                Control::Force => (-device.max_force, device.max_force),
            }
        });
        let (low, high): (Vec<_>, Vec<_>) = bounds.map(|(low, high)| (low as f32, high as f32)).unzip();
        let count = low.len();
        Space::bounded(low, high, vec![count]).map_err(|error| error.context("limits of the motors"))
    }

    /// Sends an action with the next step.
    pub fn command(&self, link: &mut dyn WebotsLink, action: &[f32]) -> Result<()> {
        for ((motor, control), value) in self.motors.iter().zip(action) {
            let value = f64::from(*value);
            let command = match control {
                Control::Position => MotorCommand::Position(value),
                Control::Velocity => MotorCommand::Velocity(value),
                Control::Force => MotorCommand::Force(value),
            };
            link.command(*motor, command)?;
        }
        Ok(())
    }

    /// Stops motors that are controlled by velocity or force: an action of the last episode must not act on.
    pub fn stop(&self, link: &mut dyn WebotsLink) -> Result<()> {
        for (motor, control) in &self.motors {
            match control {
                Control::Position => {}
                Control::Velocity => link.command(*motor, MotorCommand::Velocity(0.0))?,
                Control::Force => link.command(*motor, MotorCommand::Force(0.0))?,
            }
        }
        Ok(())
    }
}

/// Reads `NAME` or `NAME:CONTROL`.
fn one(robot: &RobotInfo, entry: &str) -> Result<(usize, Control)> {
    let (name, control) = entry.rsplit_once(':').unwrap_or((entry, "velocity"));
    let control = match control {
        "position" => Control::Position,
        "velocity" => Control::Velocity,
        "force" => Control::Force,
        _ => {
            return Err(Error::invalid_param(format!(
                "{entry:?} names no control of a motor; give NAME:position, NAME:velocity or NAME:force"
            )));
        }
    };
    let index = robot.find(name)?;
    let device = &robot.devices[index];
    if device.kind.is_some_and(DeviceKind::is_motor) {
        Ok((index, control))
    } else {
        Err(device.refused("is not a motor"))
    }
}
