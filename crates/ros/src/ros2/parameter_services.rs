//! Parameter services, by which `ros2 param`, rqt and other nodes read and set parameters, with ranges, descriptions and read-only
//! parameters.

use std::sync::atomic::AtomicI64;
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::Result;
use opendr_engine::params::{Field, ParamKind, ParamValue};
use opendr_messages::rcl_interfaces::{
    DescribeParametersResponse, FloatingPointRange, GetParameterTypesResponse, GetParametersResponse,
    IntegerRange, ListParametersRequest, ListParametersResponse, ListParametersResult, Parameter,
    ParameterDescriptor, ParameterEvent, ParameterType, ParameterValue, SetParametersAtomicallyResponse,
    SetParametersResponse, SetParametersResult,
};
use opendr_messages::{
    MessageType, RclInterfacesDescribeParameters, RclInterfacesGetParameterTypes, RclInterfacesGetParameters,
    RclInterfacesListParameters, RclInterfacesSetParameters, RclInterfacesSetParametersAtomically,
};
use opendr_ros_bridge::time;

use super::typed_services::TypedServices;
use crate::clock::{self, system_time_ns};
use crate::{ParameterTable, Publisher, Qos};

/// Quality of service of `/parameter_events` in rclcpp.
const EVENTS: Qos = Qos { reliable: true, latched: false, depth: 1000 };

/// Serves `table`; `sim_time` follows the simulated clock if the parameter is set.
pub(super) fn start(
    node: &mut impl TypedServices,
    table: Arc<ParameterTable>,
    sim_time: &Arc<AtomicI64>,
) -> Result<()> {
    if matches!(table.get("use_sim_time"), Some((_, ParamValue::Bool(true)))) {
        clock::follow(node, sim_time)?;
    }
    let events = node.advertise("/parameter_events", MessageType::RclInterfacesParameterEvent, EVENTS)?;
    let setter = Arc::new(Setter {
        table: table.clone(),
        events,
        node: node.name().to_owned(),
        one_at_a_time: Mutex::new(()),
    });
    let read = table.clone();
    node.serve_typed::<RclInterfacesGetParameters>("~/get_parameters", move |request| {
        GetParametersResponse { values: request.names.iter().map(|name| value_of(&read, name)).collect() }
    })?;
    let read = table.clone();
    node.serve_typed::<RclInterfacesGetParameterTypes>("~/get_parameter_types", move |request| {
        let types = request.names.iter().map(|name| value_of(&read, name).r#type).collect();
        GetParameterTypesResponse { types }
    })?;
    let read = table.clone();
    node.serve_typed::<RclInterfacesDescribeParameters>("~/describe_parameters", move |request| {
        let descriptor = |name: &String| match read.get(name) {
            Some((field, value)) => descriptor(field, &value),
            None => ParameterDescriptor { name: name.clone(), ..Default::default() },
        };
        DescribeParametersResponse { descriptors: request.names.iter().map(descriptor).collect() }
    })?;
    node.serve_typed::<RclInterfacesListParameters>("~/list_parameters", move |request| {
        list(&table, &request)
    })?;
    let set = setter.clone();
    node.serve_typed::<RclInterfacesSetParameters>("~/set_parameters", move |request| {
        SetParametersResponse {
            results: request.parameters.into_iter().map(|parameter| set.set(vec![parameter])).collect(),
        }
    })?;
    node.serve_typed::<RclInterfacesSetParametersAtomically>("~/set_parameters_atomically", move |request| {
        SetParametersAtomicallyResponse { result: setter.set(request.parameters) }
    })
}

struct Setter {
    table: Arc<ParameterTable>,
    events: Arc<dyn Publisher>,
    node: String,
    one_at_a_time: Mutex<()>,
}

impl Setter {
    /// Sets all parameters or none.
    fn set(&self, parameters: Vec<Parameter>) -> SetParametersResult {
        let _guard = self.one_at_a_time.lock().unwrap_or_else(PoisonError::into_inner);
        let wanted = |parameter: &Parameter| (parameter.name.clone(), param_value(&parameter.value));
        let wanted: Vec<_> = parameters.iter().map(wanted).collect();
        let checked = wanted.iter().try_for_each(|(name, value)| self.table.check(name, value));
        let set = checked
            .and_then(|()| wanted.into_iter().try_for_each(|(name, value)| self.table.set(&name, value)));
        match set {
            Ok(()) => {
                let stamp = time(system_time_ns()).unwrap_or_default();
                let event = ParameterEvent {
                    stamp,
                    node: self.node.clone(),
                    changed_parameters: parameters,
                    ..Default::default()
                };
                // Subscribers that miss the event can query the parameters.
                let _ = self.events.publish(event.into());
                SetParametersResult { successful: true, ..Default::default() }
            }
            Err(error) => SetParametersResult { successful: false, reason: error.to_string() },
        }
    }
}

fn list(table: &ParameterTable, request: &ListParametersRequest) -> ListParametersResponse {
    // Names contain no dot, so a prefix is a whole name.
    let wanted =
        |name: &str| request.prefixes.is_empty() || request.prefixes.iter().any(|prefix| prefix == name);
    let rows = table.rows();
    let names = rows.iter().map(|(field, _)| field.name.to_owned()).filter(|name| wanted(name));
    let result = ListParametersResult { names: names.collect(), prefixes: Vec::new() };
    ListParametersResponse { result }
}

fn value_of(table: &ParameterTable, name: &str) -> ParameterValue {
    table.get(name).map(|(field, value)| message_from_value(field, &value)).unwrap_or_default()
}

/// Converts a value to the type of its field: an integer in a floating-point field becomes a double.
fn message_from_value(field: &Field, value: &ParamValue) -> ParameterValue {
    let mut message = ParameterValue::default();
    match (field.kind, value) {
        (_, ParamValue::None) => {}
        (ParamKind::Float, ParamValue::Int(number)) => {
            (message.r#type, message.double_value) = (ParameterType::PARAMETER_DOUBLE, *number as f64);
        }
        (_, ParamValue::Bool(value)) => {
            (message.r#type, message.bool_value) = (ParameterType::PARAMETER_BOOL, *value);
        }
        (_, ParamValue::Int(value)) => {
            (message.r#type, message.integer_value) = (ParameterType::PARAMETER_INTEGER, *value);
        }
        (_, ParamValue::Float(value)) => {
            (message.r#type, message.double_value) = (ParameterType::PARAMETER_DOUBLE, *value);
        }
        (_, ParamValue::Text(value)) => {
            message.r#type = ParameterType::PARAMETER_STRING;
            message.string_value.clone_from(value);
        }
        (_, ParamValue::List(values)) => list_message(&mut message, values),
    }
    message
}

fn list_message(message: &mut ParameterValue, values: &[ParamValue]) {
    if let Some(numbers) = values.iter().map(int).collect::<Option<Vec<_>>>() {
        (message.r#type, message.integer_array_value) = (ParameterType::PARAMETER_INTEGER_ARRAY, numbers);
    } else if let Some(numbers) = values.iter().map(ParamValue::as_float).collect::<Option<Vec<_>>>() {
        (message.r#type, message.double_array_value) = (ParameterType::PARAMETER_DOUBLE_ARRAY, numbers);
    } else {
        message.r#type = ParameterType::PARAMETER_STRING_ARRAY;
        message.string_array_value = values.iter().map(ToString::to_string).collect();
    }
}

fn int(value: &ParamValue) -> Option<i64> {
    if let ParamValue::Int(number) = value { Some(*number) } else { None }
}

fn param_value(message: &ParameterValue) -> ParamValue {
    let list = |values: Vec<ParamValue>| ParamValue::List(values);
    match message.r#type {
        ParameterType::PARAMETER_BOOL => ParamValue::Bool(message.bool_value),
        ParameterType::PARAMETER_INTEGER => ParamValue::Int(message.integer_value),
        ParameterType::PARAMETER_DOUBLE => ParamValue::Float(message.double_value),
        ParameterType::PARAMETER_STRING => ParamValue::Text(message.string_value.clone()),
        ParameterType::PARAMETER_BYTE_ARRAY => {
            list(message.byte_array_value.iter().map(|value| ParamValue::Int((*value).into())).collect())
        }
        ParameterType::PARAMETER_BOOL_ARRAY => {
            list(message.bool_array_value.iter().copied().map(ParamValue::Bool).collect())
        }
        ParameterType::PARAMETER_INTEGER_ARRAY => {
            list(message.integer_array_value.iter().copied().map(ParamValue::Int).collect())
        }
        ParameterType::PARAMETER_DOUBLE_ARRAY => {
            list(message.double_array_value.iter().copied().map(ParamValue::Float).collect())
        }
        ParameterType::PARAMETER_STRING_ARRAY => {
            list(message.string_array_value.iter().cloned().map(ParamValue::Text).collect())
        }
        _ => ParamValue::None,
    }
}

fn descriptor(field: &Field, value: &ParamValue) -> ParameterDescriptor {
    let mut descriptor = ParameterDescriptor {
        name: field.name.to_owned(),
        r#type: message_from_value(field, value).r#type,
        description: field.doc.to_owned(),
        read_only: !field.live,
        // An optional parameter may change its type.
        dynamic_typing: field.optional,
        ..Default::default()
    };
    if !field.choices.is_empty() {
        descriptor.additional_constraints = format!("one of {}", field.choices.join(", "));
    } else if !field.unit.is_empty() {
        descriptor.additional_constraints = format!("in {}", field.unit);
    }
    match (field.range, field.kind) {
        (Some(range), ParamKind::Int) => descriptor.integer_range.push(IntegerRange {
            from_value: range.low as i64,
            to_value: range.high as i64,
            step: 1,
        }),
        (Some(range), ParamKind::Float) => descriptor.floating_point_range.push(FloatingPointRange {
            from_value: range.low,
            to_value: range.high,
            step: 0.0,
        }),
        _ => {}
    }
    descriptor
}
