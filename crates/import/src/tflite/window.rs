//! Parameters of convolutions and pools in TensorFlow's terms.

use opendr_engine::{Error, Result};

use super::options::Options;
use crate::tensorflow::{Attribute, Attributes};

/// Which fields of a table hold the parameters of a window; padding and strides come first in all of them.
pub struct Fields {
    /// Width, then height.
    pub dilation: Option<usize>,
    /// Width, then height.
    pub kernel: Option<usize>,
}

/// Reads the parameters of a window.
///
/// # Errors
/// `Format` when they are outside of the file, `Unsupported` for a padding that is not known.
pub fn window(options: &Options, fields: &Fields) -> Result<Attributes> {
    let padding = padding(options.byte(0)?)?;
    let pair = |first: Option<usize>| -> Result<Attribute> {
        let Some(first) = first else { return Ok(four(1, 1)) };
        Ok(four(options.int(first + 1, 1)?, options.int(first, 1)?))
    };
    Ok(Attributes::default()
        .with("padding", padding)
        .with("strides", pair(Some(1))?)
        .with("dilations", pair(fields.dilation)?)
        .with("ksize", pair(fields.kernel)?))
}

/// TensorFlow's name of a padding by TensorFlow Lite's number.
///
/// # Errors
/// `Unsupported` for a number that is not known.
pub fn padding(number: u8) -> Result<Attribute> {
    match number {
        0 => Ok(Attribute::Text("SAME".to_owned())),
        1 => Ok(Attribute::Text("VALID".to_owned())),
        other => Err(Error::unsupported(format!("padding number {other}"))),
    }
}

/// A parameter of height and width as a list with one number per axis.
pub fn four(height: i32, width: i32) -> Attribute {
    Attribute::Ints(vec![1, height.into(), width.into(), 1])
}
