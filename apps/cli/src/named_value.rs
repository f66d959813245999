//! `NAME=VALUE` on the command line.

use opendr::params::{Field, ParamValue};
use opendr::{Error, Result};

/// The field that `text`, given as `--flag`, names among those of `owner`, and its value.
///
/// # Errors
/// `InvalidParam` where it has no such field, or the value is of another type.
pub fn parse(flag: &str, text: &str, owner: &str, fields: &[Field]) -> Result<(String, ParamValue)> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| Error::invalid_param(format!("--{flag} {text:?} should be NAME=VALUE")))?;
    let field = fields.iter().find(|field| field.name == name).ok_or_else(|| {
        let names: Vec<_> = fields.iter().map(|field| field.name).collect();
        Error::invalid_param(format!("{owner} has no {name:?}; there are {}", names.join(", ")))
    })?;
    Ok((name.to_owned(), field.parse(value)?))
}
