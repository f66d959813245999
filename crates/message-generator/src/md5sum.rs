//! ROS 1's md5 sums of messages and services, as in genmsg's `gentools`.

use md5::{Digest, Md5};
use opendr_engine::Result;

use crate::text::{array_suffix, ros1_keyword};
use crate::{BaseType, Definition, Library, Service};

/// Returns the md5 sum of a message, which two ROS 1 nodes compare at the connection.
///
/// # Errors
/// `NotFound` for an undefined type.
pub fn md5sum(library: &Library, definition: &Definition) -> Result<String> {
    Ok(hex(&md5_text(library, definition)?))
}

/// Returns the md5 sum of a service: that of the texts of request and response.
///
/// # Errors
/// As [`md5sum`].
pub fn service_md5sum(library: &Library, service: &Service) -> Result<String> {
    let text = md5_text(library, &service.request)? + &md5_text(library, &service.response)?;
    Ok(hex(&text))
}

fn hex(text: &str) -> String {
    Md5::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn md5_text(library: &Library, definition: &Definition) -> Result<String> {
    let mut lines: Vec<String> = definition
        .constants
        .iter()
        .map(|constant| format!("{} {}={}", constant.primitive.keyword(), constant.name, constant.value))
        .collect();
    for field in &definition.fields {
        let field_type = &field.field_type;
        let line = match (&field_type.base, ros1_keyword(&field_type.base)) {
            (_, Some(keyword)) => format!("{keyword}{} {}", array_suffix(field_type.array), field.name),
            (BaseType::Message(name), None) => {
                format!("{} {}", md5sum(library, library.get(name)?)?, field.name)
            }
            (BaseType::Primitive(_), None) => continue,
        };
        lines.push(line);
    }
    Ok(lines.join("\n"))
}
