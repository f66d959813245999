//! ROS 2's type hashes (REP 2016): SHA-256 of the type description as JSON.

use opendr_engine::Result;
use sha2::{Digest, Sha256};

use crate::{Array, BaseType, Definition, Field, FieldType, Library, Primitive, Service, TypeName};

/// Dummy field of messages without fields.
pub(crate) const EMPTY_FIELD: &str = "structure_needs_at_least_one_member";

/// Returns the hash of a message, `RIHS01_` and 64 digits.
///
/// # Errors
/// `NotFound` for an undefined type.
pub fn rihs01(library: &Library, definition: &Definition) -> Result<String> {
    let used = library.dependencies(definition)?;
    let used: Vec<_> = used.into_iter().map(|used| (used.name.ros2(), used.fields.as_slice())).collect();
    Ok(hash((definition.name.ros2(), definition.fields.as_slice()), &used))
}

/// Returns the hash of a service: of its request, response and event.
///
/// # Errors
/// As [`rihs01`].
pub fn service_rihs01(library: &Library, service: &Service) -> Result<String> {
    let part = |end: &str| TypeName::new(&service.name.package, format!("{}_{end}", service.name.name));
    let field = |name: &str, name_of_type: TypeName, array| Field {
        name: name.to_owned(),
        field_type: FieldType { base: BaseType::Message(name_of_type), array },
        default: None,
        doc: String::new(),
    };
    let info = TypeName::new("service_msgs", "ServiceEventInfo");
    let event = [
        field("info", info.clone(), Array::None),
        field("request", part("Request"), Array::Bounded(1)),
        field("response", part("Response"), Array::Bounded(1)),
    ];
    let fields = [
        field("request_message", part("Request"), Array::None),
        field("response_message", part("Response"), Array::None),
        field("event_message", part("Event"), Array::None),
    ];
    let spelled = |name: &TypeName| format!("{}/srv/{}", name.package, name.name);
    let mut used = vec![
        (spelled(&part("Event")), event.as_slice()),
        (spelled(&part("Request")), service.request.fields.as_slice()),
        (spelled(&part("Response")), service.response.fields.as_slice()),
    ];
    let info = library.get(&info)?;
    used.push((info.name.ros2(), &info.fields));
    for definition in [info, &service.request, &service.response] {
        for dependency in library.dependencies(definition)? {
            used.push((dependency.name.ros2(), &dependency.fields));
        }
    }
    used.sort_by(|a, b| a.0.cmp(&b.0));
    used.dedup_by(|a, b| a.0 == b.0);
    Ok(hash((spelled(&service.name), &fields), &used))
}

fn hash(of: (String, &[Field]), used: &[(String, &[Field])]) -> String {
    let services: Vec<&str> =
        used.iter().map(|row| row.0.as_str()).filter(|name| name.contains("/srv/")).collect();
    let used: Vec<String> = used.iter().map(|(name, fields)| described(name, fields, &services)).collect();
    let json = format!(
        "{{\"type_description\": {}, \"referenced_type_descriptions\": [{}]}}",
        described(&of.0, of.1, &services),
        used.join(", ")
    );
    let digest: String = Sha256::digest(json.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    format!("RIHS01_{digest}")
}

fn described(name: &str, fields: &[Field], services: &[&str]) -> String {
    let one = |name: &str, type_id: u8, capacity: usize, nested: &str| {
        format!(
            "{{\"name\": \"{name}\", \"type\": {{\"type_id\": {type_id}, \"capacity\": {capacity}, \"string_capacity\": 0, \"nested_type_name\": \"{nested}\"}}}}"
        )
    };
    let mut written: Vec<String> = fields
        .iter()
        .map(|Field { name, field_type, .. }| {
            let (type_id, nested) = match &field_type.base {
                BaseType::Primitive(primitive) => (primitive.type_id(), String::new()),
                BaseType::Message(of) => {
                    let part = format!("{}/srv/{}", of.package, of.name);
                    (1, if services.contains(&part.as_str()) { part } else { of.ros2() })
                }
            };
            let (offset, capacity) = match field_type.array {
                Array::None => (0, 0),
                Array::Fixed(length) => (48, length),
                Array::Bounded(most) => (96, most),
                Array::Unbounded => (144, 0),
            };
            one(name, type_id + offset, capacity, &nested)
        })
        .collect();
    if written.is_empty() {
        written.push(one(EMPTY_FIELD, Primitive::Uint8.type_id(), 0, ""));
    }
    format!("{{\"type_name\": \"{name}\", \"fields\": [{}]}}", written.join(", "))
}
