//! The native client.

use std::io::{BufReader, Read, Write};

use opendr_engine::{Error, Result};

use super::answer::{self, Data, Framing};
use super::robot::Robot;
use super::stream::Stream;
use crate::device::{Device, State};
use crate::incoming::lost;
use crate::link::{DeviceInfo, MotorCommand, RobotInfo, StepEnd, WebotsLink};
use crate::request::Request;
use crate::scene::Supervisor;
use crate::version::Version;

/// Bytes that are read from the system at once.
const READ_BUFFER: usize = 1 << 16;
/// Maximum number of messages without a request that may precede an answer.
const MAX_UNSOLICITED: usize = 10_000;

/// A link by a client of the wire protocol.
#[derive(Debug)]
pub struct NativeLink<S: Write = Stream> {
    stream: BufReader<S>,
    framing: Framing,
    pub(super) robot: Robot,
    info: RobotInfo,
    request: Request,
    /// Messages of the robot itself for the next request.
    pub(super) due: Request,
    /// New values of fields, which wait for the next step.
    pub(super) new_values: Request,
    data: Data,
    steps: u64,
    is_lost: bool,
}

impl<S: Read + Write + Send> NativeLink<S> {
    /// Receives the configuration over a connection that has been greeted.
    pub(crate) fn over(stream: S, framing: Framing, version: Option<Version>) -> Result<Self> {
        let mut link = Self {
            stream: BufReader::with_capacity(READ_BUFFER, stream),
            framing,
            robot: Robot::new(version),
            info: RobotInfo {
                name: String::new(),
                is_supervisor: false,
                basic_step_ms: 0,
                devices: Vec::new(),
            },
            request: Request::default(),
            due: Request::default(),
            new_values: Request::default(),
            data: Data::default(),
            steps: 0,
            is_lost: false,
        };
        Robot::write_first(&mut link.due);
        link.exchange(0).map_err(|error| error.context("receiving the configuration of the robot"))?;
        if !link.robot.is_configured() {
            return Err(Error::format("the first answer of Webots has no configuration of the robot"));
        }
        link.info = RobotInfo {
            name: link.robot.name.clone(),
            is_supervisor: link.robot.is_supervisor,
            basic_step_ms: link.robot.basic_step_ms as u32,
            devices: link.robot.devices.iter().map(info).collect(),
        };
        Ok(link)
    }

    /// Returns the version of Webots.
    pub fn version(&self) -> Version {
        self.robot.version
    }

    /// Sends all messages and reads until Webots answers them.
    pub(super) fn exchange(&mut self, step_ms: u32) -> Result<()> {
        if self.is_lost {
            return Err(Error::network("the connection to Webots was lost before; connect again"));
        }
        // Until the exchange is complete, requests and answers may be out of step.
        self.is_lost = true;
        self.request.begin(step_ms);
        let (due, new_values) = (&mut self.due, &mut self.new_values);
        self.request.device(0, |request| {
            request.data(due.raw());
            due.clear();
            if step_ms > 0 {
                request.data(new_values.raw());
                new_values.clear();
            }
        });
        for (tag, device) in (1..).zip(&mut self.robot.devices) {
            self.request.device(tag, |request| device.write(step_ms, request));
        }
        let sent = self.stream.get_mut().write_all(self.request.finish());
        sent.map_err(|error| lost(&error))?;
        for _ in 0..MAX_UNSOLICITED {
            if answer::read(&mut self.stream, self.framing, &mut self.robot, &mut self.data)? >= 0 {
                self.is_lost = false;
                return Ok(());
            }
        }
        Err(Error::format(format!("Webots sent {MAX_UNSOLICITED} messages, but no answer")))
    }

    /// Carries out the messages that are due, without a step.
    pub(super) fn flush(&mut self) -> Result<()> {
        self.exchange(0)
    }

    /// Returns the bytes that answers and images occupy.
    #[cfg(test)]
    pub(super) fn held(&self) -> usize {
        let images = self.robot.devices.iter().map(|device| match &device.state {
            State::Imager(imager) => imager.held(),
            _ => 0,
        });
        self.data.bytes.capacity() + images.sum::<usize>()
    }

    /// Reads the images that Webots places in files.
    fn refresh(&mut self) -> Result<()> {
        for device in &mut self.robot.devices {
            if let State::Imager(imager) = &mut device.state {
                imager.refresh()?;
            }
        }
        Ok(())
    }
}

impl<S: Read + Write + Send> WebotsLink for NativeLink<S> {
    fn robot(&self) -> &RobotInfo {
        &self.info
    }

    fn enable(&mut self, device: usize, period_ms: u16) -> Result<()> {
        self.info.device(device)?;
        self.robot.devices[device].enable(period_ms)
    }

    fn command(&mut self, device: usize, command: MotorCommand) -> Result<()> {
        let info = self.info.device(device)?;
        let State::Motor(motor) = &mut self.robot.devices[device].state else {
            return Err(info.refused("is not a motor"));
        };
        if !command.is_valid() {
            return Err(info.refused("cannot be commanded to NaN"));
        }
        match command {
            MotorCommand::Position(position) => {
                motor.set_position(position);
                motor.set_velocity(motor.max_velocity);
            }
            MotorCommand::Velocity(velocity) => {
                motor.set_position(f64::INFINITY);
                motor.set_velocity(velocity);
            }
            MotorCommand::Force(force) => motor.set_force(force),
        }
        Ok(())
    }

    fn step(&mut self, step_ms: u32) -> Result<StepEnd> {
        self.info.check_step(step_ms)?;
        if self.robot.is_quitting {
            return Ok(StepEnd::Quit);
        }
        let before = self.robot.time;
        self.exchange(step_ms).and_then(|()| self.refresh()).map_err(|error| {
            error.context(format!("step {} of {} at {before:.3} s", self.steps + 1, self.info.name))
        })?;
        self.steps += 1;
        Ok(if self.robot.is_quitting { StepEnd::Quit } else { StepEnd::Running })
    }

    fn time(&self) -> f64 {
        self.robot.time
    }

    fn values(&self, device: usize, values: &mut [f64]) -> Result<()> {
        let info = self.info.device(device)?;
        let measured = match &self.robot.devices[device].state {
            State::Sensor(sensor) => sensor.values(),
            State::Motor(motor) => std::slice::from_ref(&motor.force),
            _ => &[],
        };
        if measured.is_empty() || measured.len() != values.len() {
            return Err(info.refused(&format!("measures {} numbers, not {}", measured.len(), values.len())));
        }
        values.copy_from_slice(measured);
        Ok(())
    }

    fn image(&self, device: usize) -> Result<&[u8]> {
        let info = self.info.device(device)?;
        match &self.robot.devices[device].state {
            State::Imager(imager) => Ok(imager.image()),
            _ => Err(info.refused("takes no images")),
        }
    }

    fn send(&mut self, device: usize, packet: &[u8]) -> Result<()> {
        let info = self.info.device(device)?;
        match &mut self.robot.devices[device].state {
            State::Emitter(emitter) => emitter.send(packet),
            _ => Err(info.refused("is not an emitter")),
        }
    }

    fn receive(&mut self, device: usize, packet: &mut Vec<u8>) -> Result<bool> {
        let info = self.info.device(device)?;
        match &mut self.robot.devices[device].state {
            State::Receiver(receiver) => Ok(receiver.receive(packet)),
            _ => Err(info.refused("is not a receiver")),
        }
    }

    fn supervisor(&mut self) -> Result<&mut dyn Supervisor> {
        if self.robot.is_supervisor {
            return Ok(self);
        }
        Err(self.info.no_supervisor())
    }
}

impl<S: Write> Drop for NativeLink<S> {
    fn drop(&mut self) {
        // A request of size 0 ends the connection; a peer that has gone needs none.
        let _ = self.stream.get_mut().write_all(&[0; 4]);
    }
}

/// Describes a device.
fn info(device: &Device) -> DeviceInfo {
    let mut info = DeviceInfo::new(device.name.clone(), device.model.clone(), device.kind());
    match &device.state {
        State::Motor(motor) => {
            info.range = (motor.min_position, motor.max_position);
            (info.max_velocity, info.max_force) = (motor.max_velocity, motor.max_force);
        }
        State::Sensor(sensor) => info.range = sensor.range.unwrap_or(info.range),
        State::Imager(imager) => {
            info.size = (imager.width, imager.height);
            info.range = (imager.near, imager.max_range);
        }
        State::Emitter(_) | State::Receiver(_) | State::Unknown(_) => {}
    }
    info
}
