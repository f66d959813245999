//! Motors of joints.

use opendr_engine::Result;

use super::opcodes::CONFIGURE;
use crate::kind::DeviceKind;
use crate::reader::Reader;
use crate::request::Request;

const SET_POSITION: u16 = 1;
const SET_VELOCITY: u16 = 2;
const SET_FORCE: u16 = 4;
const FEEDBACK: u16 = 5;
const FEEDBACK_DATA: u8 = 5;
const ASSOCIATED_DEVICE: u8 = 8;

/// A motor. Targets are sent with the next step.
#[derive(Debug, Clone)]
pub(crate) struct Motor {
    pub kind: DeviceKind,
    pub min_position: f64,
    pub max_position: f64,
    pub max_velocity: f64,
    pub max_force: f64,
    /// Measured force or torque; NaN until it is measured.
    pub force: f64,
    /// New values by opcode: position, velocity, available force (never set), force.
    due: [Option<f64>; 4],
    new_feedback: Option<u16>,
}

impl Motor {
    pub(super) fn new(kind: DeviceKind) -> Self {
        let unknown = f64::NAN;
        Self {
            kind,
            min_position: unknown,
            max_position: unknown,
            max_velocity: unknown,
            max_force: unknown,
            force: unknown,
            due: [None; 4],
            new_feedback: None,
        }
    }

    fn set(&mut self, opcode: u16, value: f64) {
        self.due[usize::from(opcode - SET_POSITION)] = Some(value);
    }

    /// Sets the target position; infinity for control of the velocity.
    pub fn set_position(&mut self, position: f64) {
        self.set(SET_POSITION, position);
    }

    pub fn set_velocity(&mut self, velocity: f64) {
        self.set(SET_VELOCITY, velocity);
    }

    /// Sets the force or torque that the motor exerts.
    pub fn set_force(&mut self, force: f64) {
        self.set(SET_FORCE, force);
    }

    pub(super) fn enable_feedback(&mut self, period_ms: u16) {
        self.new_feedback = Some(period_ms);
    }

    pub(super) fn write(&mut self, request: &mut Request) {
        for (opcode, due) in (SET_POSITION..).zip(&mut self.due) {
            if let Some(value) = due.take() {
                request.u16(opcode);
                request.f64(value);
            }
        }
        if let Some(period) = self.new_feedback.take() {
            request.u16(FEEDBACK);
            request.u16(period);
        }
    }

    pub(super) fn apply_message(&mut self, command: u8, reader: &mut Reader<'_>) -> Result<bool> {
        match command {
            CONFIGURE => self.configure(reader)?,
            FEEDBACK_DATA => self.force = reader.f64()?,
            ASSOCIATED_DEVICE => drop(reader.u16()?),
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn configure(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        let _joint = reader.i32()?;
        self.min_position = reader.f64()?;
        self.max_position = reader.f64()?;
        self.max_velocity = reader.f64()?;
        let _acceleration = reader.f64()?;
        self.max_force = reader.f64()?;
        // P, I, D, position, velocity, multiplier.
        reader.fill(&mut [0.0; 6])?;
        let coupled = reader.count(2)?;
        reader.bytes(2 * coupled).map(drop)
    }
}
