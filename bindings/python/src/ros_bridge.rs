//! Conversion between serialised messages of rclpy and rospy and data and targets.

use opendr::ros::bridge::{RosBridge, message_types};
use opendr::ros::messages::{Message, MessageType, WireFormat};
use opendr::{Error, Result, ValueType};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::datum::{python_from_value, value_from_python};
use crate::error::ToPython;

/// Returns the ROS 2 names of the messages that map to the type called `kind`; the first is the default.
#[pyfunction]
pub fn ros_message_types(py: Python<'_>, kind: &str) -> PyResult<Vec<&'static str>> {
    let kind: ValueType = kind.parse().to_python(py)?;
    Ok(message_types(kind).map(MessageType::ros2_name).collect())
}

/// Converts a serialised message to a datum or target; `kind` is the name of its type, by default the first type that the message
/// maps to.
#[pyfunction]
pub fn value_from_ros<'py>(
    py: Python<'py>,
    bytes: &[u8],
    message: &str,
    is_ros1: bool,
    kind: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let bytes = bytes.to_vec();
    let read = || -> Result<_> {
        let message: MessageType = message.parse()?;
        let kind = match kind {
            Some(kind) => kind.parse()?,
            None => default_type(message)?,
        };
        RosBridge::default().value_from_message(kind, Message::from_bytes(message, wire(is_ros1), &bytes)?)
    };
    let value = py.detach(read).to_python(py)?;
    python_from_value(py, value.as_value_ref())
}

/// Converts a datum or target of the type called `kind` to a serialised message.
#[pyfunction]
pub fn ros_from_value<'py>(
    py: Python<'py>,
    value: &Bound<'_, PyAny>,
    kind: &str,
    message: &str,
    is_ros1: bool,
    class_ids: &str,
    jpeg_quality: u8,
) -> PyResult<Bound<'py, PyBytes>> {
    let kind: ValueType = kind.parse().to_python(py)?;
    let value = value_from_python(value, kind)?;
    let write = || -> Result<_> {
        let class_ids = opendr::params::Param::from_value(&class_ids.into()).ok_or_else(|| {
            Error::invalid_param(format!("class_ids = {class_ids:?}; give \"names\" or \"numbers\""))
        })?;
        let bridge = RosBridge { class_ids, jpeg_quality };
        bridge.message_from_value(value.as_value_ref(), message.parse()?)?.to_bytes(wire(is_ros1))
    };
    Ok(PyBytes::new(py, &py.detach(write).to_python(py)?))
}

const fn wire(is_ros1: bool) -> WireFormat {
    if is_ros1 { WireFormat::Ros1 } else { WireFormat::Cdr }
}

fn default_type(message: MessageType) -> Result<ValueType> {
    let is_default = |kind: &ValueType| message_types(*kind).next() == Some(message);
    let kinds = ValueType::ALL.iter().copied();
    kinds
        .clone()
        .find(is_default)
        .or_else(|| kinds.clone().find(|kind| message_types(*kind).any(|known| known == message)))
        .ok_or_else(|| Error::unsupported(format!("{} maps to no data or target type", message.ros2_name())))
}
