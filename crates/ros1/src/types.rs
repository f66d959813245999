//! Types of topics and services.

use opendr_engine::{Error, Result};

/// Type of a topic's messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TopicType {
    /// Name such as `sensor_msgs/Image`; `*` in a subscriber matches any.
    pub name: String,
    /// md5 sum of 32 lower-case hexadecimal digits; `*` in a subscriber matches any.
    pub md5sum: String,
    /// Definition with those of all contained types, as printed by `gendeps --cat`; may be empty for a subscriber.
    pub definition: String,
}

impl TopicType {
    /// Creates a type from name, md5 sum and definition.
    pub fn new(name: impl Into<String>, md5sum: impl Into<String>, definition: impl Into<String>) -> Self {
        Self { name: name.into(), md5sum: md5sum.into(), definition: definition.into() }
    }

    /// Returns the type of a subscriber to any type.
    pub fn any() -> Self {
        Self::new("*", "*", "")
    }

    pub(crate) fn check_concrete(&self) -> Result<()> {
        check_type(&self.name)?;
        check_md5sum(&self.md5sum)
    }

    pub(crate) fn check(&self) -> Result<()> {
        if self.name != "*" {
            check_type(&self.name)?;
        }
        if self.md5sum == "*" { Ok(()) } else { check_md5sum(&self.md5sum) }
    }
}

/// Type of a service.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ServiceType {
    /// Name such as `std_srvs/SetBool`.
    pub name: String,
    /// md5 sum of 32 lower-case hexadecimal digits; `*` in a client matches any.
    pub md5sum: String,
    /// Name of the request type, such as `std_srvs/SetBoolRequest`.
    pub request_type: String,
    /// Name of the response type, such as `std_srvs/SetBoolResponse`.
    pub response_type: String,
}

impl ServiceType {
    /// Creates a service type; request and response types are named after it.
    pub fn new(name: impl Into<String>, md5sum: impl Into<String>) -> Self {
        let name = name.into();
        Self {
            request_type: format!("{name}Request"),
            response_type: format!("{name}Response"),
            md5sum: md5sum.into(),
            name,
        }
    }

    pub(crate) fn check_concrete(&self) -> Result<()> {
        check_type(&self.name)?;
        check_md5sum(&self.md5sum)
    }
}

/// Returns whether two md5 sums or type names match; `*` matches any.
pub(crate) fn agree(one: &str, other: &str) -> bool {
    one == "*" || other == "*" || one == other
}

fn check_type(name: &str) -> Result<()> {
    let part = |part: &str| {
        !part.is_empty() && part.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
    };
    match name.split_once('/') {
        Some((package, kind)) if part(package) && part(kind) => Ok(()),
        _ => Err(Error::invalid_param(format!(
            "{name:.80?} is not a ROS 1 type; write a name such as std_msgs/String"
        ))),
    }
}

fn check_md5sum(md5sum: &str) -> Result<()> {
    let digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    if md5sum.len() == 32 && md5sum.bytes().all(digit) {
        return Ok(());
    }
    Err(Error::invalid_param(format!(
        "{md5sum:.80?} is not an md5 sum; give 32 lower-case hexadecimal digits"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_checked() {
        let sum = "992ce8a1687cec8c8bd883ec73ca41d1";
        assert!(TopicType::new("std_msgs/String", sum, "string data").check_concrete().is_ok());
        assert!(TopicType::any().check().is_ok());
        assert!(TopicType::any().check_concrete().is_err());
        assert!(TopicType::new("String", sum, "").check().is_err());
        assert!(TopicType::new("a/b/c", sum, "").check().is_err());
        assert!(TopicType::new("a/b", "992CE8", "").check().is_err());
        assert_eq!(ServiceType::new("std_srvs/Empty", sum).request_type, "std_srvs/EmptyRequest");
        assert!(agree("*", "a") && agree("a", "*") && agree("a", "a") && !agree("a", "b"));
    }
}
