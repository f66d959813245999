//! The map of depths among a network's outputs.

use opendr_engine::{Error, Result};
use opendr_inference::TensorView;
use opendr_perception_common::exported_network::{Facts, depth_output};

/// Returns the index of the map of depths: the output `name`, else the recognised one.
///
/// # Errors
/// `Unsupported` if there is no such output, or several.
pub(super) fn find_output(facts: &Facts, name: Option<&str>) -> Result<usize> {
    let named = |name: &str| facts.outputs.iter().position(|output| output.name == name);
    // The only output of a network that is named by nothing is what the user says that it is.
    let only = || (facts.outputs.len() == 1).then_some(0);
    match name {
        Some(name) => named(name).ok_or_else(|| {
            Error::unsupported(format!("the network has no output {name:?} ({})", facts.describe()))
        }),
        None => depth_output(facts).or_else(only).ok_or_else(|| {
            Error::unsupported(format!(
                "none of the network's outputs is named as depths; set depth_output ({})",
                facts.describe()
            ))
        }),
    }
}

/// A map with one value for each pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct DepthMap<'a> {
    /// Values, row by row.
    pub values: &'a [f32],
    /// Number of columns and rows.
    pub size: [usize; 2],
}

impl<'a> DepthMap<'a> {
    /// Reads an output.
    ///
    /// # Errors
    /// `Format` for another shape; `InvalidInput` for other elements than floats.
    pub fn of(output: &TensorView<'a>) -> Result<Self> {
        let size = match *output.shape() {
            [1, rows, columns] | [1, 1, rows, columns] | [1, rows, columns, 1] | [rows, columns] => {
                [columns, rows]
            }
            _ => [0; 2],
        };
        let values = output.values::<f32>()?;
        if values.is_empty() || values.len() != size[0] * size[1] {
            return Err(Error::format(format!(
                "the network returns {:?}, which is not a map [1, height, width] or [1, 1, height, width]; set depth_output",
                output.shape()
            )));
        }
        Ok(Self { values, size })
    }
}
