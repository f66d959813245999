//! The requests of a supervisor.

use std::io::{Read, Write};

use opendr_engine::{Error, Result};

use super::client::NativeLink;
use super::scene::{
    FIELD_FROM_NAME, NODE_FROM_DEF, POSITION, RESET_PHYSICS, RESET_SIMULATION, SET_VALUE, SET_VELOCITY,
    VALUE, VELOCITY, write_value,
};
use crate::scene::{FieldKind, FieldRef, FieldValue, NodeRef, Supervisor};

/// Index of a field with one value.
const SINGLE: u32 = u32::MAX;
/// Stands for no PROTO in which a node is looked for.
const NO_PROTO: i32 = -1;

impl<S: Read + Write + Send> NativeLink<S> {
    fn check_scene_requests(&self) -> Result<()> {
        if self.version().has_scene_requests() {
            return Ok(());
        }
        Err(Error::unsupported(format!(
            "the native client does not know how {} asks for nodes and fields; connect with libController (feature \
             webots-library)",
            self.version()
        )))
    }
}

impl<S: Read + Write + Send> Supervisor for NativeLink<S> {
    fn node(&mut self, def: &str) -> Result<NodeRef> {
        self.check_scene_requests()?;
        check_name(def)?;
        self.due.u8(NODE_FROM_DEF);
        self.due.text(def);
        self.due.i32(NO_PROTO);
        self.flush()?;
        match self.robot.scene.node.take() {
            Some(id) if id != 0 => Ok(NodeRef(id as usize)),
            _ => Err(Error::not_found(format!("the scene has no node DEF {def}"))),
        }
    }

    fn field(&mut self, node: NodeRef, name: &str) -> Result<FieldRef> {
        self.check_scene_requests()?;
        check_name(name)?;
        self.due.u8(FIELD_FROM_NAME);
        self.due.u32(node.0 as u32);
        self.due.text(name);
        self.due.u8(0);
        self.flush()?;
        let Some((id, number)) = self.robot.scene.field.take().filter(|(id, _)| *id >= 0) else {
            return Err(Error::not_found(format!("the node has no field {name}")));
        };
        let kind = FieldKind::numbered(number)
            .ok_or_else(|| Error::unsupported(format!("field {name} has several values or nodes")))?;
        Ok(FieldRef { node: node.0, id: id as usize, kind })
    }

    fn value(&mut self, field: FieldRef) -> Result<FieldValue> {
        self.check_scene_requests()?;
        self.due.u8(VALUE);
        self.due.u32(field.node as u32);
        self.due.u32(field.id as u32);
        self.due.u8(0);
        self.flush()?;
        let value = self.robot.scene.value.take().filter(|value| value.kind() == field.kind);
        value.ok_or_else(|| Error::not_found("the node of the field no longer exists"))
    }

    fn set_value(&mut self, field: FieldRef, value: &FieldValue) -> Result<()> {
        self.check_scene_requests()?;
        value.check(field.kind)?;
        self.new_values.u8(SET_VALUE);
        self.new_values.u32(field.node as u32);
        self.new_values.u32(field.id as u32);
        self.new_values.u32(field.kind as u32);
        self.new_values.u32(SINGLE);
        write_value(value, &mut self.new_values);
        Ok(())
    }

    fn position(&mut self, node: NodeRef) -> Result<[f64; 3]> {
        self.due.u8(POSITION);
        self.due.u32(node.0 as u32);
        self.flush()?;
        self.robot.scene.position.take().ok_or_else(unanswered)
    }

    fn velocity(&mut self, node: NodeRef) -> Result<[f64; 6]> {
        self.due.u8(VELOCITY);
        self.due.u32(node.0 as u32);
        self.flush()?;
        self.robot.scene.velocity.take().ok_or_else(unanswered)
    }

    fn set_velocity(&mut self, node: NodeRef, velocity: &[f64; 6]) -> Result<()> {
        if !velocity.iter().all(|part| part.is_finite()) {
            return Err(Error::invalid_param(format!("the velocity {velocity:?} is not finite")));
        }
        self.due.u8(SET_VELOCITY);
        self.due.u32(node.0 as u32);
        velocity.iter().for_each(|part| self.due.f64(*part));
        self.flush()
    }

    fn reset_physics(&mut self, node: NodeRef) -> Result<()> {
        self.due.u8(RESET_PHYSICS);
        self.due.u32(node.0 as u32);
        self.flush()
    }

    fn reset_simulation(&mut self) -> Result<()> {
        self.due.u8(RESET_SIMULATION);
        self.flush()
    }
}

fn check_name(name: &str) -> Result<()> {
    if name.is_empty() || name.contains('\0') {
        return Err(Error::invalid_param(format!("{name:?} is no name of a node or field")));
    }
    Ok(())
}

fn unanswered() -> Error {
    Error::format("Webots did not answer the request for a node; does it still exist?")
}
