//! The link.

use std::ffi::{CStr, c_char, c_double, c_int};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use opendr_engine::{Error, Result};

use super::functions::{Functions, Tag};
use crate::kind::DeviceKind;
use crate::link::{DeviceInfo, MotorCommand, RobotInfo, StepEnd, WebotsLink};
use crate::scene::Supervisor;

/// A link through `libController`.
///
/// The library serves one robot per process and ends the process when it loses Webots: for an error instead, use
/// [`NativeLink`](crate::NativeLink). It reads the robot's address from `WEBOTS_CONTROLLER_URL`.
pub struct LibraryLink {
    pub(super) functions: Functions,
    info: RobotInfo,
    tags: Vec<Tag>,
    has_quit: bool,
}

/// Whether this process has a robot.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

impl LibraryLink {
    /// Loads the library and connects; waits until Webots is there, at most 50 s.
    ///
    /// # Errors
    /// Returns `NotFound` if the library cannot be loaded, `Unsupported` if this process already has a robot, or the library lacks a
    /// function.
    pub fn connect(library: &Path) -> Result<Self> {
        let functions = Functions::load(library)?;
        if IS_TAKEN.swap(true, Ordering::SeqCst) {
            return Err(Error::unsupported(
                "libController serves one robot per process; start a process for each",
            ));
        }
        // SAFETY: called once per process, before every other function.
        if unsafe { (functions.robot_init)() } == 0 {
            return Err(Error::network("libController could not connect to Webots"));
        }
        // SAFETY: the robot is initialised, as for all calls below.
        let count = unsafe { (functions.robot_get_number_of_devices)() };
        // SAFETY: the indices are below the number of devices.
        let tags: Vec<_> =
            (0..count).map(|index| unsafe { (functions.robot_get_device_by_index)(index) }).collect();
        let devices = tags.iter().map(|tag| info(&functions, *tag)).collect::<Result<_>>()?;
        let info = RobotInfo {
            // SAFETY: the library returns a string that lives until the next configuration.
            name: text(unsafe { (functions.robot_get_name)() })?,
            // SAFETY: see above.
            is_supervisor: unsafe { (functions.robot_get_supervisor)() },
            // SAFETY: see above.
            basic_step_ms: unsafe { (functions.robot_get_basic_time_step)() } as u32,
            devices,
        };
        Ok(Self { functions, info, tags, has_quit: false })
    }

    /// Returns the path of the library in `$WEBOTS_HOME`.
    ///
    /// # Errors
    /// Returns `NotFound` if `WEBOTS_HOME` is not set.
    pub fn installed() -> Result<PathBuf> {
        let home = std::env::var_os("WEBOTS_HOME").filter(|home| !home.is_empty());
        let home =
            home.ok_or_else(|| Error::not_found("WEBOTS_HOME is not set; set it to the folder of Webots"))?;
        let file = match std::env::consts::OS {
            "windows" => "lib/controller/Controller.dll",
            "macos" => "Contents/lib/controller/libController.dylib",
            _ => "lib/controller/libController.so",
        };
        Ok(PathBuf::from(home).join(file))
    }

    /// Returns a device's description, kind and number.
    fn device(&self, device: usize) -> Result<(&DeviceInfo, Option<DeviceKind>, Tag)> {
        let info = self.info.device(device)?;
        Ok((info, info.kind, self.tags[device]))
    }
}

/// Copies a string of the library.
pub(super) fn text(pointer: *const c_char) -> Result<String> {
    if pointer.is_null() {
        return Ok(String::new());
    }
    // SAFETY: the library's strings end in a zero byte and live at least until its next call.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str()
        .map(str::to_owned)
        .map_err(|error| Error::format("a name in Webots is not UTF-8").with_source(error))
}

/// Describes a device.
fn info(functions: &Functions, tag: Tag) -> Result<DeviceInfo> {
    // SAFETY: `tag` is a device of the initialised robot; the kind selects functions for it, as for all calls below.
    let (name, model, node) = unsafe {
        let node = (functions.node_get_name)((functions.device_get_node_type)(tag));
        (text((functions.device_get_name)(tag))?, text((functions.device_get_model)(tag))?, text(node)?)
    };
    let kind = DeviceKind::named(&node);
    let mut info = DeviceInfo::new(name, model, kind);
    let size = |width: c_int, height: c_int| {
        (usize::try_from(width).unwrap_or(0), usize::try_from(height).unwrap_or(0))
    };
    // SAFETY: see above.
    unsafe {
        match kind {
            Some(kind) if kind.is_motor() => {
                info.range =
                    ((functions.motor_get_min_position)(tag), (functions.motor_get_max_position)(tag));
                info.max_velocity = (functions.motor_get_max_velocity)(tag);
                info.max_force = (functions.motor_get_max_force)(tag);
            }
            Some(DeviceKind::DistanceSensor) => {
                let range = (
                    (functions.distance_sensor_get_min_value)(tag),
                    (functions.distance_sensor_get_max_value)(tag),
                );
                info.range = range;
            }
            Some(DeviceKind::Camera) => {
                info.size = size((functions.camera_get_width)(tag), (functions.camera_get_height)(tag));
            }
            Some(DeviceKind::RangeFinder) => {
                info.size =
                    size((functions.range_finder_get_width)(tag), (functions.range_finder_get_height)(tag));
                info.range = (
                    (functions.range_finder_get_min_range)(tag),
                    (functions.range_finder_get_max_range)(tag),
                );
            }
            Some(DeviceKind::Lidar) => {
                let columns = (functions.lidar_get_horizontal_resolution)(tag);
                info.size = size(columns, (functions.lidar_get_number_of_layers)(tag));
                info.range = ((functions.lidar_get_min_range)(tag), (functions.lidar_get_max_range)(tag));
            }
            _ => {}
        }
    }
    Ok(info)
}

impl WebotsLink for LibraryLink {
    fn robot(&self) -> &RobotInfo {
        &self.info
    }

    fn enable(&mut self, device: usize, period_ms: u16) -> Result<()> {
        let (info, kind, tag) = self.device(device)?;
        let functions = &self.functions;
        let enable = match kind {
            Some(kind) if kind.is_motor() => functions.motor_enable_force_feedback,
            Some(DeviceKind::PositionSensor) => functions.position_sensor_enable,
            Some(DeviceKind::DistanceSensor) => functions.distance_sensor_enable,
            Some(DeviceKind::Gps) => functions.gps_enable,
            Some(DeviceKind::InertialUnit) => functions.inertial_unit_enable,
            Some(DeviceKind::Accelerometer) => functions.accelerometer_enable,
            Some(DeviceKind::Gyro) => functions.gyro_enable,
            Some(DeviceKind::Compass) => functions.compass_enable,
            Some(DeviceKind::Camera) => functions.camera_enable,
            Some(DeviceKind::RangeFinder) => functions.range_finder_enable,
            Some(DeviceKind::Lidar) => functions.lidar_enable,
            Some(DeviceKind::Receiver) => functions.receiver_enable,
            _ => return Err(info.refused("is not a sensor")),
        };
        // SAFETY: the function is the one for this kind of device.
        unsafe { enable(tag, period_ms.into()) };
        Ok(())
    }

    fn command(&mut self, device: usize, command: MotorCommand) -> Result<()> {
        let (info, kind, tag) = self.device(device)?;
        if !kind.is_some_and(DeviceKind::is_motor) {
            return Err(info.refused("is not a motor"));
        }
        if !command.is_valid() {
            return Err(info.refused("cannot be commanded to NaN"));
        }
        let max_velocity = info.max_velocity;
        // SAFETY: the device is a motor.
        unsafe {
            match command {
                MotorCommand::Position(position) => {
                    (self.functions.motor_set_position)(tag, position);
                    (self.functions.motor_set_velocity)(tag, max_velocity);
                }
                MotorCommand::Velocity(velocity) => {
                    (self.functions.motor_set_position)(tag, f64::INFINITY);
                    (self.functions.motor_set_velocity)(tag, velocity);
                }
                MotorCommand::Force(force) => (self.functions.motor_set_force)(tag, force),
            }
        }
        Ok(())
    }

    fn step(&mut self, step_ms: u32) -> Result<StepEnd> {
        self.info.check_step(step_ms)?;
        let duration = c_int::try_from(step_ms).map_err(|_| Error::invalid_param("a step is too long"))?;
        // The library ends the process if it is asked for a step after the end.
        // SAFETY: the robot is initialised.
        self.has_quit = self.has_quit || unsafe { (self.functions.robot_step)(duration) } == -1;
        Ok(if self.has_quit { StepEnd::Quit } else { StepEnd::Running })
    }

    fn time(&self) -> f64 {
        // SAFETY: the robot is initialised.
        unsafe { (self.functions.robot_get_time)() }
    }

    fn values(&self, device: usize, values: &mut [f64]) -> Result<()> {
        let (info, kind, tag) = self.device(device)?;
        let functions = &self.functions;
        let expected = kind.map_or(0, |kind| if kind.is_motor() { 1 } else { kind.values() });
        if expected == 0 || expected != values.len() {
            return Err(info.refused(&format!("measures {expected} numbers, not {}", values.len())));
        }
        // SAFETY: each function is the one for this kind of device.
        unsafe {
            match kind {
                Some(DeviceKind::PositionSensor) => values[0] = (functions.position_sensor_get_value)(tag),
                Some(DeviceKind::DistanceSensor) => values[0] = (functions.distance_sensor_get_value)(tag),
                Some(DeviceKind::Gps) => {
                    copy((functions.gps_get_values)(tag), &mut values[..3]);
                    values[3] = (functions.gps_get_speed)(tag);
                    copy((functions.gps_get_speed_vector)(tag), &mut values[4..]);
                }
                Some(DeviceKind::InertialUnit) => copy((functions.inertial_unit_get_quaternion)(tag), values),
                Some(DeviceKind::Accelerometer) => copy((functions.accelerometer_get_values)(tag), values),
                Some(DeviceKind::Gyro) => copy((functions.gyro_get_values)(tag), values),
                Some(DeviceKind::Compass) => copy((functions.compass_get_values)(tag), values),
                _ => values[0] = (functions.motor_get_force_feedback)(tag),
            }
        }
        Ok(())
    }

    fn image(&self, device: usize) -> Result<&[u8]> {
        let (info, kind, tag) = self.device(device)?;
        // SAFETY: each function is the one for this kind of device.
        let pointer = unsafe {
            match kind {
                Some(DeviceKind::Camera) => (self.functions.camera_get_image)(tag),
                Some(DeviceKind::RangeFinder) => (self.functions.range_finder_get_range_image)(tag).cast(),
                Some(DeviceKind::Lidar) => (self.functions.lidar_get_range_image)(tag).cast(),
                _ => return Err(info.refused("takes no images")),
            }
        };
        let (width, height) = info.size;
        if pointer.is_null() {
            return Ok(&[]);
        }
        // SAFETY: the library keeps 4 bytes for each pixel or range, which change only with a step, for which `self` is borrowed.
        Ok(unsafe { std::slice::from_raw_parts(pointer, 4 * width * height) })
    }

    fn send(&mut self, device: usize, packet: &[u8]) -> Result<()> {
        let (info, kind, tag) = self.device(device)?;
        if kind != Some(DeviceKind::Emitter) {
            return Err(info.refused("is not an emitter"));
        }
        let size = c_int::try_from(packet.len()).unwrap_or(0);
        // SAFETY: the library copies `size` bytes of the packet.
        if size == 0 || unsafe { (self.functions.emitter_send)(tag, packet.as_ptr().cast(), size) } == 0 {
            return Err(Error::invalid_input(format!("a packet of {} bytes cannot be sent", packet.len())));
        }
        Ok(())
    }

    fn receive(&mut self, device: usize, packet: &mut Vec<u8>) -> Result<bool> {
        let (info, kind, tag) = self.device(device)?;
        if kind != Some(DeviceKind::Receiver) {
            return Err(info.refused("is not a receiver"));
        }
        // SAFETY: the device is a receiver; the data are those of the first packet, until the next call.
        unsafe {
            if (self.functions.receiver_get_queue_length)(tag) <= 0 {
                return Ok(false);
            }
            let size = usize::try_from((self.functions.receiver_get_data_size)(tag)).unwrap_or(0);
            let data = (self.functions.receiver_get_data)(tag);
            packet.clear();
            if !data.is_null() {
                packet.extend_from_slice(std::slice::from_raw_parts(data.cast::<u8>(), size));
            }
            (self.functions.receiver_next_packet)(tag);
        }
        Ok(true)
    }

    fn supervisor(&mut self) -> Result<&mut dyn Supervisor> {
        if self.info.is_supervisor { Ok(self) } else { Err(self.info.no_supervisor()) }
    }
}

impl Drop for LibraryLink {
    fn drop(&mut self) {
        // SAFETY: the robot is initialised, and no function is called after this one.
        unsafe { (self.functions.robot_cleanup)() };
    }
}

/// Copies as many numbers as `values` has; NaN if the library has none.
///
/// # Safety
/// `from` is null or points to that many numbers.
pub(super) unsafe fn copy(from: *const c_double, values: &mut [f64]) {
    if from.is_null() {
        values.fill(f64::NAN);
    } else {
        // SAFETY: the caller vouches for the numbers.
        values.copy_from_slice(unsafe { std::slice::from_raw_parts(from, values.len()) });
    }
}
