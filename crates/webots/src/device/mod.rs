//! Devices of a robot as the native client keeps them: configuration, measurements, and messages to be sent.

mod channels;
mod emitter;
mod imager;
mod motor;
mod opcodes;
mod receiver;
mod sensor;

use opendr_engine::{Error, Result};

use crate::kind::DeviceKind;
use crate::reader::Reader;
use crate::request::Request;
use crate::version::Version;

pub(crate) use emitter::Emitter;
pub(crate) use imager::Imager;
pub(crate) use motor::Motor;
pub(crate) use opcodes::CONFIGURE;
use opcodes::write_period;
pub(crate) use receiver::Receiver;
pub(crate) use sensor::Sensor;

/// A device.
#[derive(Debug, Clone)]
pub(crate) struct Device {
    pub name: String,
    pub model: String,
    pub state: State,
}

/// What a device is.
#[derive(Debug, Clone)]
pub(crate) enum State {
    Motor(Motor),
    Sensor(Sensor),
    Imager(Imager),
    Emitter(Emitter),
    Receiver(Receiver),
    /// A node number whose messages are not known.
    Unknown(u16),
}

impl Device {
    /// Reads number, name and model.
    pub fn read(reader: &mut Reader<'_>, version: Version) -> Result<Self> {
        let node = reader.u16()?;
        let kind = DeviceKind::ALL.iter().copied().find(|kind| version.device_node(*kind) == node);
        let state = match kind {
            None => State::Unknown(node),
            Some(kind) if kind.is_motor() => State::Motor(Motor::new(kind)),
            Some(kind) if kind.is_imager() => State::Imager(Imager::new(kind)),
            Some(DeviceKind::Emitter) => State::Emitter(Emitter::default()),
            Some(DeviceKind::Receiver) => State::Receiver(Receiver::default()),
            Some(kind) => State::Sensor(Sensor::new(kind)),
        };
        let (name, model) = (reader.text()?.to_owned(), reader.text()?.to_owned());
        Ok(Self { name, model, state })
    }

    /// Returns the kind; none for a device that is not known.
    pub fn kind(&self) -> Option<DeviceKind> {
        match &self.state {
            State::Motor(motor) => Some(motor.kind),
            State::Sensor(sensor) => Some(sensor.kind),
            State::Imager(imager) => Some(imager.kind),
            State::Emitter(_) => Some(DeviceKind::Emitter),
            State::Receiver(_) => Some(DeviceKind::Receiver),
            State::Unknown(_) => None,
        }
    }

    /// Reads one message of Webots.
    pub fn apply_message(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        let command = reader.u8()?;
        let known = match &mut self.state {
            State::Motor(motor) => motor.apply_message(command, reader),
            State::Sensor(sensor) => sensor.apply_message(command, reader),
            State::Imager(imager) => imager.apply_message(command, reader),
            State::Emitter(emitter) => emitter.apply_message(command, reader),
            State::Receiver(receiver) => receiver.apply_message(command, reader),
            State::Unknown(node) => {
                return Err(Error::unsupported(format!(
                    "Webots sent a message of device {:?}, whose type (node number {node}) the native client does not know; \
                     connect with libController (feature webots-library)",
                    self.name
                )));
            }
        };
        match known {
            Ok(true) => Ok(()),
            Ok(false) => Err(Error::format(format!(
                "command {command} of device {:?} is not known; is this the version of Webots that was named?",
                self.name
            ))),
            Err(error) => Err(error.context(format!("device {:?}", self.name))),
        }
    }

    /// Writes the messages that are due, as Webots' own library orders them.
    pub fn write(&mut self, step_ms: u32, request: &mut Request) {
        match &mut self.state {
            State::Motor(motor) => motor.write(request),
            State::Sensor(sensor) => write_period(&mut sensor.new_period, request),
            State::Imager(imager) => imager.write(request),
            State::Emitter(emitter) => emitter.write(step_ms, request),
            State::Receiver(receiver) => receiver.write(request),
            State::Unknown(_) => {}
        }
    }

    /// Sets the sampling period of a sensor; 0 stops it.
    pub fn enable(&mut self, period_ms: u16) -> Result<()> {
        match &mut self.state {
            State::Motor(motor) => motor.enable_feedback(period_ms),
            State::Sensor(sensor) => sensor.enable(period_ms),
            State::Imager(imager) => imager.enable(period_ms),
            State::Receiver(receiver) => receiver.enable(period_ms),
            State::Emitter(_) | State::Unknown(_) => {
                return Err(Error::invalid_param(format!("device {:?} is not a sensor", self.name)));
            }
        }
        Ok(())
    }
}
