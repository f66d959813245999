//! Arguments of the form `NAME=VALUE`.

use opendr::params::{Field, ParamValue};
use opendr::{Error, Result};

/// Parses `text`, the argument of `--flag`, into the name and value of one of the `fields` of `owner`.
///
/// # Errors
/// `InvalidParam` for an unknown field or a value of another type.
pub fn parse(flag: &str, text: &str, owner: &str, fields: &[Field]) -> Result<(String, ParamValue)> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| Error::invalid_param(format!("--{flag} {text:?} should be NAME=VALUE")))?;
    let field = fields.iter().find(|field| field.is_called(name)).ok_or_else(|| {
        let names: Vec<_> = fields.iter().map(|field| field.name).collect();
        Error::invalid_param(format!("{owner} has no parameter {name:?}; it has {}", names.join(", ")))
    })?;
    Ok((field.name.to_owned(), field.parse(value)?))
}
