//! The robot: its configuration, and messages that are not of a device.

use opendr_engine::{Error, Result};

use super::scene::Scene;
use crate::device::{CONFIGURE, Device};
use crate::reader::Reader;
use crate::request::Request;
use crate::version::Version;

const QUIT: u8 = 2;
const TIME: u8 = 4;
const BATTERY: u8 = 5;
const WINDOW_SHOW: u8 = 9;
const CHANGE_MODE: u8 = 10;
const CUSTOM_DATA: u8 = 11;
const SUPERVISOR: u8 = 12;
const MODEL: u8 = 13;
const WINDOW_UPDATE: u8 = 14;
const NEW_DEVICES: u8 = 15;
const WINDOW_MESSAGE: u8 = 81;
const SET_JOYSTICK_PERIOD: u8 = 35;
/// Bytes of the shortest device in a configuration.
const SHORTEST_DEVICE: usize = 4;

/// What Webots said of the robot.
#[derive(Debug, Clone)]
pub(crate) struct Robot {
    pub version: Version,
    /// Whether the user has named the version.
    is_named: bool,
    pub name: String,
    pub is_supervisor: bool,
    pub basic_step_ms: f64,
    pub world: String,
    pub time: f64,
    pub is_quitting: bool,
    pub devices: Vec<Device>,
    pub scene: Scene,
    is_configured: bool,
}

impl Robot {
    pub fn new(version: Option<Version>) -> Self {
        Self {
            version: version.unwrap_or(Version::R2023b),
            is_named: version.is_some(),
            name: String::new(),
            is_supervisor: false,
            basic_step_ms: 0.0,
            world: String::new(),
            time: 0.0,
            is_quitting: false,
            devices: Vec::new(),
            scene: Scene::default(),
            is_configured: false,
        }
    }

    /// Returns whether the configuration has arrived.
    pub fn is_configured(&self) -> bool {
        self.is_configured
    }

    /// Writes what Webots' own library writes first: that no joystick is used.
    pub fn write_first(request: &mut Request) {
        request.u8(SET_JOYSTICK_PERIOD);
        request.u16(0);
    }

    /// Reads all messages of an answer.
    pub fn read(&mut self, bytes: &[u8]) -> Result<()> {
        let mut reader = Reader::new(bytes);
        while !reader.is_over() {
            match reader.u16()? {
                0 => self.apply_message(&mut reader)?,
                tag => self.device(tag)?.apply_message(&mut reader)?,
            }
        }
        Ok(())
    }

    /// Returns the device with this tag, from 1.
    pub fn device(&mut self, tag: u16) -> Result<&mut Device> {
        let count = self.devices.len();
        let device = usize::from(tag).checked_sub(1).and_then(|index| self.devices.get_mut(index));
        device.ok_or_else(|| Error::format(format!("a message of device {tag}, but the robot has {count}")))
    }

    fn apply_message(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        match reader.u8()? {
            CONFIGURE if !self.is_configured => self.configure(reader)?,
            CONFIGURE if self.is_supervisor && !self.scene.is_configured() => self.scene.configure(reader)?,
            CONFIGURE => {
                return Err(Error::unsupported("Webots has loaded another world; connect to it again"));
            }
            QUIT => self.is_quitting = true,
            TIME => self.time = reader.f64()?,
            BATTERY => drop(reader.f64()?),
            WINDOW_SHOW | WINDOW_UPDATE => {}
            CHANGE_MODE => drop(reader.i32()?),
            CUSTOM_DATA | MODEL => drop(reader.text()?),
            SUPERVISOR => self.is_supervisor = reader.u8()? != 0,
            NEW_DEVICES => {
                let count = reader.u16()?;
                self.add_devices(count, reader)?;
            }
            WINDOW_MESSAGE => {
                let size = reader.count(1)?;
                reader.bytes(size)?;
            }
            command if self.is_supervisor && self.scene.apply_message(command, reader)? => {}
            command => {
                return Err(Error::format(format!(
                    "command {command} of the robot is not known; is this the version of Webots that was named ({})?",
                    self.version
                )));
            }
        }
        Ok(())
    }

    fn configure(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        if self.version.is_stated() {
            self.read_name_and_version(reader)?;
        }
        self.is_supervisor = reader.u8()? != 0;
        let _synchronization = reader.u8()?;
        let count = reader.u16()?;
        let node = reader.u16()?;
        if count == 0 || node != self.version.robot_node() {
            return Err(Error::format(format!(
                "the configuration has {count} devices and the node number {node}, a robot of {} has {}; set the version \
                 to that of Webots",
                self.version,
                self.version.robot_node()
            )));
        }
        self.time = reader.f64()?;
        if !self.version.is_stated() {
            self.name = reader.text()?.to_owned();
        }
        self.add_devices(count - 1, reader)?;
        self.basic_step_ms = reader.f64()?;
        let _project = reader.text()?;
        self.world = reader.text()?.to_owned();
        // Model, window, remote control, controller, custom data.
        for _ in 0..5 {
            reader.text()?;
        }
        let (_show_window, _html_window) = (reader.u8()?, reader.u8()?);
        let _mode = reader.i32()?;
        if !(self.basic_step_ms >= 1.0 && self.basic_step_ms <= 1e6) {
            return Err(Error::format(format!("a time step of {} ms is not possible", self.basic_step_ms)));
        }
        self.is_configured = true;
        Ok(())
    }

    fn read_name_and_version(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        // Without name and version, the configuration begins with a flag, which is no letter.
        if reader.clone().u8()? <= 1 {
            return Err(Error::unsupported(
                "Webots does not state its version; if it is R2023a, set the version to R2023a",
            ));
        }
        self.name = reader.text()?.to_owned();
        let stated = Version::parse(reader.text()?)?;
        if self.is_named && stated != self.version {
            let named = self.version;
            return Err(Error::invalid_param(format!(
                "Webots states the version {stated}, not {named}; set the version to it"
            )));
        }
        self.version = stated;
        Ok(())
    }

    fn add_devices(&mut self, count: u16, reader: &mut Reader<'_>) -> Result<()> {
        let fits = usize::from(count) <= reader.left() / SHORTEST_DEVICE;
        if !fits || self.devices.len() + usize::from(count) >= usize::from(u16::MAX) {
            return Err(Error::format(format!(
                "{count} devices do not fit a message with {} bytes",
                reader.left()
            )));
        }
        for _ in 0..count {
            self.devices.push(Device::read(reader, self.version)?);
        }
        Ok(())
    }
}
