//! Answers to the requests of a supervisor.

use opendr_engine::{Error, Result};

use crate::reader::Reader;
use crate::request::Request;
use crate::scene::{FieldKind, FieldValue};

pub(super) const RESET_SIMULATION: u8 = 55;
pub(super) const SET_VALUE: u8 = 62;
pub(super) const SET_VELOCITY: u8 = 66;
pub(super) const RESET_PHYSICS: u8 = 67;
pub(super) const NODE_FROM_DEF: u8 = 84;
pub(super) const FIELD_FROM_NAME: u8 = 87;
pub(super) const VALUE: u8 = 88;
pub(super) const POSITION: u8 = 90;
pub(super) const VELOCITY: u8 = 96;
const REGENERATED: u8 = 19;
const COUNT_CHANGED: u8 = 20;
const NODE_REMOVED: u8 = 97;

/// The last answer of each kind; taken by the request that asked for it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scene {
    is_configured: bool,
    /// Number of the node, 0 if there is none.
    pub(super) node: Option<u32>,
    /// Number and type of the field, -1 if there is none.
    pub(super) field: Option<(i32, i32)>,
    pub(super) value: Option<FieldValue>,
    pub(super) position: Option<[f64; 3]>,
    pub(super) velocity: Option<[f64; 6]>,
}

impl Scene {
    pub(super) fn is_configured(&self) -> bool {
        self.is_configured
    }

    /// Reads the robot's own node.
    pub(super) fn configure(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        let (_own, _parent) = (reader.u32()?, reader.u32()?);
        let (_is_proto, _is_internal) = (reader.u8()?, reader.u8()?);
        let (_model, _def) = (reader.text()?, reader.text()?);
        self.is_configured = true;
        Ok(())
    }

    /// Reads an answer; returns false for an unknown command.
    pub(super) fn apply_message(&mut self, command: u8, reader: &mut Reader<'_>) -> Result<bool> {
        match command {
            NODE_FROM_DEF => {
                self.node = Some(reader.u32()?);
                let (_type, _tag, _parent) = (reader.u32()?, reader.i32()?, reader.u32()?);
                let (_is_proto, _model) = (reader.u8()?, reader.text()?);
            }
            FIELD_FROM_NAME => {
                self.field = Some((reader.i32()?, reader.i32()?));
                let (_is_internal, _count, _name) = (reader.u8()?, reader.i32()?, reader.text()?);
            }
            VALUE => {
                // The type is 0 if the node no longer exists.
                let number = reader.i32()?;
                if number != 0 {
                    let (_node, _field) = (reader.i32()?, reader.i32()?);
                    self.value = Some(read_value(number, reader)?);
                }
            }
            POSITION => self.position = Some(numbers(reader)?),
            VELOCITY => self.velocity = Some(numbers(reader)?),
            REGENERATED | RESET_SIMULATION => {}
            COUNT_CHANGED => {
                let (_parent, _name, _count) = (reader.i32()?, reader.text()?, reader.i32()?);
            }
            NODE_REMOVED => drop(reader.u32()?),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn numbers<const N: usize>(reader: &mut Reader<'_>) -> Result<[f64; N]> {
    let mut numbers = [0.0; N];
    reader.fill(&mut numbers)?;
    Ok(numbers)
}

fn read_value(number: i32, reader: &mut Reader<'_>) -> Result<FieldValue> {
    let Some(kind) = FieldKind::numbered(number) else {
        return Err(Error::format(format!("a field has the unknown type {number}")));
    };
    Ok(match kind {
        FieldKind::Bool => FieldValue::Bool(reader.u8()? != 0),
        FieldKind::Int32 => FieldValue::Int32(reader.i32()?),
        FieldKind::Float => FieldValue::Float(reader.f64()?),
        FieldKind::Vec2 => FieldValue::Vec2(numbers(reader)?),
        FieldKind::Vec3 => FieldValue::Vec3(numbers(reader)?),
        FieldKind::Rotation => FieldValue::Rotation(numbers(reader)?),
        FieldKind::Color => FieldValue::Color(numbers(reader)?),
        FieldKind::Text => FieldValue::Text(reader.text()?.to_owned()),
    })
}

/// Writes a value as it follows the index of the field.
pub(super) fn write_value(value: &FieldValue, request: &mut Request) {
    let mut numbers = |numbers: &[f64]| numbers.iter().for_each(|number| request.f64(*number));
    match value {
        FieldValue::Bool(flag) => request.u8(u8::from(*flag)),
        FieldValue::Int32(number) => request.i32(*number),
        FieldValue::Float(number) => numbers(&[*number]),
        FieldValue::Vec2(parts) => numbers(parts),
        FieldValue::Vec3(parts) | FieldValue::Color(parts) => numbers(parts),
        FieldValue::Rotation(parts) => numbers(parts),
        FieldValue::Text(text) => request.text(text),
    }
}
