//! Which output of a network is a map of classes, and how it lies in memory.

use opendr_engine::data::Layout;
use opendr_engine::{Error, Result};
use opendr_inference::{ElementType, TensorInfo, TensorView};
use opendr_perception_common::exported_network::{Facts, is_class_map, is_integer};

use super::params::MapFormat;

/// Returns the index of the map of classes: the output `name`, else `out` of torchvision or `logits` of transformers, else the only one
/// with the shape of a map.
///
/// # Errors
/// `Unsupported` if there is no such output, or several.
pub(super) fn map_output(facts: &Facts, name: Option<&str>) -> Result<usize> {
    let named = |name: &str| facts.outputs.iter().position(|output| output.name == name);
    let found = match name {
        Some(name) => named(name),
        None => ["out", "logits"]
            .into_iter()
            .find_map(named)
            .filter(|at| is_class_map(&facts.outputs[*at]))
            .or_else(|| facts.only_output(is_class_map)),
    };
    found.ok_or_else(|| {
        Error::unsupported(match name {
            Some(name) => format!("the network has no output {name:?} ({})", facts.describe()),
            None => format!(
                "the network has not one output of a map of classes, [1, classes, height, width], [1, height, width, classes] or \
                 [1, height, width] with integers; set map_output if it has several ({})",
                facts.describe()
            ),
        })
    })
}

/// Returns the format of an output, if its shape and the layout of the network's input settle it.
pub(super) fn recognised(output: &TensorInfo, input: Layout) -> MapFormat {
    match output.dims.len() {
        _ if is_integer(output) || output.element_type == ElementType::U8 => MapFormat::Labels,
        4 if input == Layout::Hwc => MapFormat::ChannelsLast,
        4 => MapFormat::ChannelsFirst,
        _ => MapFormat::Labels,
    }
}

/// A map of classes in a network's output.
#[derive(Clone, Copy)]
pub(super) enum Map<'a> {
    /// Scores, and the steps from a class, a row and a column to the next.
    Scores { values: &'a [f32], strides: [usize; 3] },
    /// Indices of classes, row by row.
    Labels(Labels<'a>),
}

/// Indices of classes of any integer type.
#[derive(Clone, Copy)]
pub(super) enum Labels<'a> {
    Long(&'a [i64]),
    Int(&'a [i32]),
    Byte(&'a [u8]),
}

impl Labels<'_> {
    /// Returns the class at a place.
    ///
    /// # Errors
    /// `Format` for a negative one.
    pub fn at(&self, place: usize) -> Result<u32> {
        let label = match self {
            Self::Long(labels) => labels.get(place).copied(),
            Self::Int(labels) => labels.get(place).map(|label| i64::from(*label)),
            Self::Byte(labels) => labels.get(place).map(|label| i64::from(*label)),
        };
        let label = label.ok_or_else(|| Error::internal("a place outside the map"))?;
        u32::try_from(label).map_err(|_| {
            Error::format(format!("the network returns the invalid class {label}; load another model"))
        })
    }
}

impl<'a> Map<'a> {
    /// Reads an output; also returns the number of classes (0 for labels), rows and columns.
    ///
    /// # Errors
    /// `Format` for an output of another shape than the format states.
    pub fn of(output: &TensorView<'a>, format: MapFormat) -> Result<(Self, [usize; 3])> {
        let wrong = || {
            Error::format(format!(
                "the network returns {:?}, which is not a map of the format {format:?}; set map",
                output.shape()
            ))
        };
        let scores = |classes: usize, rows: usize, columns: usize, strides| {
            let values = output.values::<f32>()?;
            let is_whole = values.len() == classes * rows * columns && !values.is_empty();
            if is_whole {
                Ok((Self::Scores { values, strides }, [classes, rows, columns]))
            } else {
                Err(wrong())
            }
        };
        match (format, output.shape()) {
            (MapFormat::ChannelsFirst, &[1, classes, rows, columns]) => {
                scores(classes, rows, columns, [rows * columns, columns, 1])
            }
            (MapFormat::ChannelsLast, &[1, rows, columns, classes]) => {
                scores(classes, rows, columns, [1, columns * classes, classes])
            }
            (MapFormat::Labels, &([1, rows, columns] | [1, 1, rows, columns] | [1, rows, columns, 1])) => {
                let labels = match output.element_type() {
                    ElementType::I64 => Labels::Long(output.values()?),
                    ElementType::I32 => Labels::Int(output.values()?),
                    ElementType::U8 => Labels::Byte(output.values()?),
                    _ => return Err(wrong()),
                };
                if rows * columns == 0 {
                    Err(wrong())
                } else {
                    Ok((Self::Labels(labels), [0, rows, columns]))
                }
            }
            _ => Err(wrong()),
        }
    }
}
