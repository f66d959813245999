//! Definitions as text, for recordings and ROS 1 connections.

use std::fmt::Write as _;

use crate::{Array, BaseType, Definition};

/// Returns the keyword of a primitive type of ROS 1.
pub(crate) fn ros1_keyword(base: &BaseType) -> Option<&'static str> {
    match base {
        BaseType::Primitive(primitive) => Some(primitive.keyword()),
        BaseType::Message(name) if name.package == "builtin_interfaces" => match name.name.as_str() {
            "Time" => Some("time"),
            "Duration" => Some("duration"),
            _ => None,
        },
        BaseType::Message(_) => None,
    }
}

pub(crate) fn array_suffix(array: Array) -> String {
    match array {
        Array::None => String::new(),
        Array::Fixed(length) => format!("[{length}]"),
        Array::Bounded(most) => format!("[<={most}]"),
        Array::Unbounded => "[]".to_owned(),
    }
}

/// Returns the lines of a definition without comments; with `ros1`, in ROS 1's syntax of times and without default values.
pub fn definition_text(definition: &Definition, ros1: bool) -> String {
    let mut text = String::new();
    for constant in &definition.constants {
        let _ = writeln!(text, "{} {}={}", constant.primitive.keyword(), constant.name, constant.value);
    }
    for field in &definition.fields {
        let array = array_suffix(field.field_type.array);
        let base = match (ros1_keyword(&field.field_type.base), &field.field_type.base) {
            (Some(keyword), _) if ros1 => keyword.to_owned(),
            (_, BaseType::Primitive(primitive)) => primitive.keyword().to_owned(),
            (_, BaseType::Message(name)) => name.to_string(),
        };
        let default = match &field.default {
            Some(value) if !ros1 => format!(" {value}"),
            _ => String::new(),
        };
        let _ = writeln!(text, "{base}{array} {}{default}", field.name);
    }
    text
}
