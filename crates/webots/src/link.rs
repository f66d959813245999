//! The link between a controller and the simulator.

use opendr_engine::{Error, Result};

use crate::kind::DeviceKind;
use crate::scene::Supervisor;

/// A device of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceInfo {
    /// Name, as in the world file.
    pub name: String,
    /// Model, as in the world file; often empty.
    pub model: String,
    /// Kind; none for a device that this crate cannot use.
    pub kind: Option<DeviceKind>,
    /// Columns and rows of its images or ranges; 0 for other devices.
    pub size: (usize, usize),
    /// Smallest and largest value: of motors the positions (equal if unlimited), of ranges and distances in m.
    pub range: (f64, f64),
    /// Maximum velocity of a motor, in rad/s or m/s; NaN for other devices.
    pub max_velocity: f64,
    /// Maximum force or torque of a motor, in N or N m; NaN for other devices.
    pub max_force: f64,
}

/// A robot.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotInfo {
    /// Name.
    pub name: String,
    /// Whether it is a supervisor.
    pub is_supervisor: bool,
    /// Time step of the world, in ms: the steps of controllers are multiples of it.
    pub basic_step_ms: u32,
    /// Devices, in the order of the world file.
    pub devices: Vec<DeviceInfo>,
}

/// A command to a motor, carried out with the next step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotorCommand {
    /// Target position in rad or m.
    Position(f64),
    /// Velocity in rad/s or m/s, without a target position.
    Velocity(f64),
    /// Force or torque in N or N m.
    Force(f64),
}

/// How a step ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepEnd {
    /// The simulation goes on.
    Running,
    /// Webots ends the simulation or loads another world: the controller should end.
    Quit,
}

/// A connection to one robot of a simulation, as the robot's controller.
///
/// Devices are named by their index in [`RobotInfo::devices`]. Sensors measure once they are enabled, and first with the next step.
pub trait WebotsLink: Send {
    /// Returns what the robot is.
    fn robot(&self) -> &RobotInfo;

    /// Sets the sampling period of a sensor, or of a motor's force measurement; 0 stops it.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the device does not measure.
    fn enable(&mut self, device: usize, period_ms: u16) -> Result<()>;

    /// Commands a motor.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the device is not a motor or the value is NaN.
    fn command(&mut self, device: usize, command: MotorCommand) -> Result<()>;

    /// Lets `step_ms` pass, a multiple of the basic time step, and waits for the measurements.
    ///
    /// # Errors
    /// Returns `Network` if the connection is lost, `Format` for messages that do not follow the protocol.
    fn step(&mut self, step_ms: u32) -> Result<StepEnd>;

    /// Returns the time of the simulation, in s.
    fn time(&self) -> f64;

    /// Writes the last measurement of a sensor or the force of a motor; NaN before the first one.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the device does not measure as many numbers.
    fn values(&self, device: usize, values: &mut [f64]) -> Result<()>;

    /// Returns the last image of a camera (4 bytes a pixel: blue, green, red, alpha), or the ranges of a range finder or lidar as
    /// little-endian `f32` in m; empty before the first one.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the device takes no images.
    fn image(&self, device: usize) -> Result<&[u8]>;

    /// Sends a packet with the next step.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the device is not an emitter, `InvalidInput` if the packet is empty or its buffer is full.
    fn send(&mut self, device: usize, packet: &[u8]) -> Result<()>;

    /// Replaces `packet` by the oldest packet of a receiver; returns false if there is none.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the device is not a receiver.
    fn receive(&mut self, device: usize, packet: &mut Vec<u8>) -> Result<bool>;

    /// Returns the access to the scene.
    ///
    /// # Errors
    /// Returns `Unsupported` if the robot is not a supervisor.
    fn supervisor(&mut self) -> Result<&mut dyn Supervisor>;
}

impl DeviceInfo {
    /// Creates a description without limits.
    pub(crate) fn new(name: String, model: String, kind: Option<DeviceKind>) -> Self {
        let unlimited = (f64::NEG_INFINITY, f64::INFINITY);
        Self {
            name,
            model,
            kind,
            size: (0, 0),
            range: unlimited,
            max_velocity: f64::NAN,
            max_force: f64::NAN,
        }
    }

    /// Returns the error of a request that does not fit this device.
    pub(crate) fn refused(&self, why: &str) -> Error {
        let kind = self.kind.map_or("device", DeviceKind::name);
        Error::invalid_param(format!("{kind} {:?} {why}", self.name))
    }
}

impl MotorCommand {
    /// Returns whether the value is a number.
    pub(crate) fn is_valid(self) -> bool {
        let (Self::Position(value) | Self::Velocity(value) | Self::Force(value)) = self;
        !value.is_nan()
    }
}

impl RobotInfo {
    /// Returns a device.
    pub(crate) fn device(&self, index: usize) -> Result<&DeviceInfo> {
        self.devices.get(index).ok_or_else(|| {
            Error::invalid_param(format!("there is no device {index}; the robot has {}", self.devices.len()))
        })
    }

    /// Checks a step that a controller asks for.
    pub(crate) fn check_step(&self, step_ms: u32) -> Result<()> {
        if step_ms > 0 && step_ms.is_multiple_of(self.basic_step_ms) {
            return Ok(());
        }
        Err(Error::invalid_param(format!(
            "a step of {step_ms} ms is no multiple of the basic time step of {} ms",
            self.basic_step_ms
        )))
    }

    /// Returns the error for a robot that is no supervisor.
    pub(crate) fn no_supervisor(&self) -> Error {
        Error::unsupported(format!(
            "robot {:?} is not a supervisor; set its field supervisor to TRUE",
            self.name
        ))
    }

    /// Returns the index of the device with this name.
    ///
    /// # Errors
    /// Returns `NotFound` with the names of all devices.
    pub fn find(&self, name: &str) -> Result<usize> {
        self.devices.iter().position(|device| device.name == name).ok_or_else(|| {
            let names: Vec<_> = self.devices.iter().map(|device| device.name.as_str()).collect();
            let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            Error::not_found(format!("robot {:?} has no device {name:?}; its devices: {names}", self.name))
        })
    }
}
