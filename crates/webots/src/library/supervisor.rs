//! The scene.

use std::ffi::CString;

use opendr_engine::{Error, Result};

use super::functions::Pointer;
use super::link::{LibraryLink, copy, text};
use crate::scene::{FieldKind, FieldRef, FieldValue, NodeRef, Supervisor};

impl Supervisor for LibraryLink {
    fn node(&mut self, def: &str) -> Result<NodeRef> {
        let name = c_text(def)?;
        // SAFETY: the robot is an initialised supervisor, as for all calls below; the name ends in a zero byte.
        let node = unsafe { (self.functions.supervisor_node_get_from_def)(name.as_ptr()) };
        if node.is_null() {
            return Err(Error::not_found(format!("the scene has no node DEF {def}")));
        }
        Ok(NodeRef(node as usize))
    }

    fn field(&mut self, node: NodeRef, name: &str) -> Result<FieldRef> {
        let c_name = c_text(name)?;
        // SAFETY: the node is one that the library returned; it checks whether it still exists.
        let field = unsafe { (self.functions.supervisor_node_get_field)(pointer(node.0), c_name.as_ptr()) };
        if field.is_null() {
            return Err(Error::not_found(format!("the node has no field {name}")));
        }
        // SAFETY: the field is one that the library returned.
        let number = unsafe { (self.functions.supervisor_field_get_type)(field) };
        let kind = FieldKind::numbered(number)
            .ok_or_else(|| Error::unsupported(format!("field {name} has several values or nodes")))?;
        Ok(FieldRef { node: node.0, id: field as usize, kind })
    }

    fn value(&mut self, field: FieldRef) -> Result<FieldValue> {
        let (functions, at) = (&self.functions, pointer(field.id));
        // SAFETY: the field is one that the library returned, of this type.
        Ok(unsafe {
            match field.kind {
                FieldKind::Bool => FieldValue::Bool((functions.supervisor_field_get_sf_bool)(at)),
                FieldKind::Int32 => FieldValue::Int32((functions.supervisor_field_get_sf_int32)(at)),
                FieldKind::Float => FieldValue::Float((functions.supervisor_field_get_sf_float)(at)),
                FieldKind::Vec2 => FieldValue::Vec2(numbers((functions.supervisor_field_get_sf_vec2f)(at))?),
                FieldKind::Vec3 => FieldValue::Vec3(numbers((functions.supervisor_field_get_sf_vec3f)(at))?),
                FieldKind::Rotation => {
                    FieldValue::Rotation(numbers((functions.supervisor_field_get_sf_rotation)(at))?)
                }
                FieldKind::Color => {
                    FieldValue::Color(numbers((functions.supervisor_field_get_sf_color)(at))?)
                }
                FieldKind::Text => FieldValue::Text(text((functions.supervisor_field_get_sf_string)(at))?),
            }
        })
    }

    fn set_value(&mut self, field: FieldRef, value: &FieldValue) -> Result<()> {
        value.check(field.kind)?;
        let (functions, at) = (&self.functions, pointer(field.id));
        // SAFETY: the field is one that the library returned, of this type; the library copies the values.
        unsafe {
            match value {
                FieldValue::Bool(flag) => (functions.supervisor_field_set_sf_bool)(at, *flag),
                FieldValue::Int32(number) => (functions.supervisor_field_set_sf_int32)(at, *number),
                FieldValue::Float(number) => (functions.supervisor_field_set_sf_float)(at, *number),
                FieldValue::Vec2(parts) => (functions.supervisor_field_set_sf_vec2f)(at, parts.as_ptr()),
                FieldValue::Vec3(parts) => (functions.supervisor_field_set_sf_vec3f)(at, parts.as_ptr()),
                FieldValue::Rotation(parts) => {
                    (functions.supervisor_field_set_sf_rotation)(at, parts.as_ptr())
                }
                FieldValue::Color(parts) => (functions.supervisor_field_set_sf_color)(at, parts.as_ptr()),
                FieldValue::Text(text) => {
                    (functions.supervisor_field_set_sf_string)(at, c_text(text)?.as_ptr())
                }
            }
        }
        Ok(())
    }

    fn position(&mut self, node: NodeRef) -> Result<[f64; 3]> {
        // SAFETY: the node is one that the library returned; it checks whether it still exists.
        numbers(unsafe { (self.functions.supervisor_node_get_position)(pointer(node.0)) })
    }

    fn velocity(&mut self, node: NodeRef) -> Result<[f64; 6]> {
        // SAFETY: as in `position`.
        numbers(unsafe { (self.functions.supervisor_node_get_velocity)(pointer(node.0)) })
    }

    fn set_velocity(&mut self, node: NodeRef, velocity: &[f64; 6]) -> Result<()> {
        if !velocity.iter().all(|part| part.is_finite()) {
            return Err(Error::invalid_param(format!("the velocity {velocity:?} is not finite")));
        }
        // SAFETY: as in `position`; the library reads 6 numbers.
        unsafe { (self.functions.supervisor_node_set_velocity)(pointer(node.0), velocity.as_ptr()) };
        Ok(())
    }

    fn reset_physics(&mut self, node: NodeRef) -> Result<()> {
        // SAFETY: as in `position`.
        unsafe { (self.functions.supervisor_node_reset_physics)(pointer(node.0)) };
        Ok(())
    }

    fn reset_simulation(&mut self) -> Result<()> {
        // SAFETY: the robot is an initialised supervisor.
        unsafe { (self.functions.supervisor_simulation_reset)() };
        Ok(())
    }
}

fn pointer(address: usize) -> Pointer {
    address as Pointer
}

fn c_text(text: &str) -> Result<CString> {
    CString::new(text)
        .map_err(|error| Error::invalid_param(format!("{text:?} has a zero byte")).with_source(error))
}

/// Copies numbers of the library.
fn numbers<const N: usize>(from: *const f64) -> Result<[f64; N]> {
    if from.is_null() {
        return Err(Error::not_found("Webots did not answer the request for a node; does it still exist?"));
    }
    let mut numbers = [0.0; N];
    // SAFETY: the library's pointers to numbers have as many as the header states.
    unsafe { copy(from, &mut numbers) };
    Ok(numbers)
}
