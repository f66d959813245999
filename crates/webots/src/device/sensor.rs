//! Sensors that measure a few numbers.

use opendr_engine::Result;

use super::opcodes::CONFIGURE;
use crate::kind::DeviceKind;
use crate::reader::Reader;

/// A sensor of numbers. They are NaN until the first measurement.
#[derive(Debug, Clone)]
pub(crate) struct Sensor {
    pub kind: DeviceKind,
    values: [f64; 7],
    /// Smallest and largest value, if the configuration states them.
    pub range: Option<(f64, f64)>,
    pub(super) new_period: Option<u16>,
}

impl Sensor {
    pub fn new(kind: DeviceKind) -> Self {
        Self { kind, values: [f64::NAN; 7], range: None, new_period: None }
    }

    /// Returns the last measurement.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.kind.values()]
    }

    pub(super) fn enable(&mut self, period_ms: u16) {
        self.new_period = Some(period_ms);
    }

    /// Returns the opcode of a measurement.
    const fn data(&self) -> u8 {
        match self.kind {
            DeviceKind::PositionSensor => 1,
            DeviceKind::Gps => 2,
            DeviceKind::DistanceSensor => 50,
            DeviceKind::Accelerometer => 51,
            DeviceKind::Compass => 52,
            DeviceKind::Gyro => 53,
            _ => 54,
        }
    }

    pub(super) fn apply_message(&mut self, command: u8, reader: &mut Reader<'_>) -> Result<bool> {
        if command == CONFIGURE {
            self.configure(reader)?;
        } else if command == self.data() {
            reader.fill(&mut self.values[..self.kind.values()])?;
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    fn configure(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        match self.kind {
            DeviceKind::DistanceSensor => {
                let _kind = reader.i32()?;
                self.range = Some((reader.f64()?, reader.f64()?));
                let _aperture = reader.f64()?;
                skip_table(reader)
            }
            // The type of the joint, the coordinate system.
            DeviceKind::PositionSensor | DeviceKind::Gps => reader.i32().map(drop),
            DeviceKind::InertialUnit => {
                let _noise = reader.f64()?;
                reader.text().map(drop)
            }
            _ => skip_table(reader),
        }
    }
}

/// Skips a lookup table: Webots applies it itself.
fn skip_table(reader: &mut Reader<'_>) -> Result<()> {
    const ROW: usize = 24;
    let rows = reader.count(ROW)?;
    reader.bytes(rows * ROW).map(drop)
}
