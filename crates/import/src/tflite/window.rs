//! Mapping of window parameters to TensorFlow's.

use opendr_engine::{Error, Result};

use super::options::Options;
use crate::tensorflow::{Attribute, Attributes};

/// Fields of a table with the parameters of a window; padding and strides come first in all of them.
pub struct Fields {
    /// Field of the width; the height follows.
    pub dilation: Option<usize>,
    /// Field of the width; the height follows.
    pub kernel: Option<usize>,
}

/// Reads the parameters of a window.
///
/// # Errors
/// `Format` when they are outside the file, `Unsupported` for an unknown padding mode.
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

/// Returns TensorFlow's name of a padding mode by TensorFlow Lite's number.
///
/// # Errors
/// `Unsupported` for an unknown number.
pub fn padding(number: u8) -> Result<Attribute> {
    match number {
        0 => Ok(Attribute::Text("SAME".to_owned())),
        1 => Ok(Attribute::Text("VALID".to_owned())),
        other => Err(Error::unsupported(format!("unsupported padding {other}"))),
    }
}

/// Returns height and width as a list with one number per axis.
pub fn four(height: i32, width: i32) -> Attribute {
    Attribute::Ints(vec![1, height.into(), width.into(), 1])
}
