//! The image input of a classifier of another tool, which may be a central crop.

use opendr_engine::{Error, Result};
use opendr_perception_common::exported_network::{Facts, InputConvention, InputParams, InputResize};

/// Combines the parameters with the convention that was recognised, if one was, and writes the result into the parameters. An input that
/// was recognised is cropped unless a parameter sets how it is resized.
///
/// # Errors
/// `Unsupported` for what is neither recognised nor given.
pub fn settle_input(
    params: &mut InputParams,
    crop: &mut Option<f32>,
    known: Option<InputConvention>,
    facts: &Facts,
) -> Result<InputConvention> {
    if crop.is_none() {
        let is_cropped = known.is_some() && params.resize == InputResize::Auto;
        *crop = Some(if is_cropped { 1.0 } else { 0.0 });
    }
    let input = params.settle(known.unwrap_or(InputConvention::UNKNOWN));
    let missing: Vec<_> = input.missing().collect();
    if missing.is_empty() {
        return Ok(input);
    }
    Err(Error::unsupported(format!(
        "the network does not state how it was trained; set {}, and crop if it was trained on central crops ({})",
        missing.join(", "),
        facts.describe()
    )))
}
