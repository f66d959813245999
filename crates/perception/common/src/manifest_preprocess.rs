//! Pre-processing from a model's manifest: `inputs.image` with `mean`, `std` and `colour`.

use opendr_engine::model::Model;
use opendr_engine::{Error, Result};
use opendr_inference::TensorInfo;
use opendr_vision::{ChannelOrder, Preprocess};
use serde_json::Value;

use crate::exported_network::in_order;
use crate::image_network::preprocess_from_input;

/// Returns the pre-processing for the network's `input`: its size and layout, and the normalisation `(level - mean) / std`
/// of levels 0..=255 from the manifest. `mean` and `std` default to `usual`, `colour` to RGB.
///
/// # Errors
/// `Format` when the network's input is not an image of a fixed size, or when the manifest's values are invalid.
pub fn preprocess_from_manifest(model: &Model, input: &TensorInfo, usual: f32) -> Result<Preprocess> {
    let preprocess = preprocess_from_input(input)?;
    let StatedInput { mean, std, order } = StatedInput::of(model)?;
    let order = order.unwrap_or(ChannelOrder::Rgb);
    Ok(preprocess.order(order).normalise(mean.unwrap_or([usual; 3]), std.unwrap_or([usual; 3])))
}

/// What a manifest states in `inputs.image`, in the order of the network's channels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StatedInput {
    /// Mean level of the training, of 0..=255.
    pub mean: Option<[f32; 3]>,
    /// Standard deviation of the levels.
    pub std: Option<[f32; 3]>,
    /// Order of the colour channels.
    pub order: Option<ChannelOrder>,
}

impl StatedInput {
    /// Reads the manifest of a model.
    ///
    /// # Errors
    /// `Format` for invalid values.
    pub fn of(model: &Model) -> Result<Self> {
        let described = model.manifest().inputs.get("image");
        let entry = |key: &str| described.and_then(|image| image.get(key));
        let std = entry("std").map(three).transpose()?;
        if std.is_some_and(|std| std.contains(&0.0)) {
            return Err(Error::format(
                "inputs.image of the model has std = 0; give the standard deviation of its training",
            ));
        }
        let order = match entry("colour").and_then(Value::as_str) {
            None => None,
            Some("rgb") => Some(ChannelOrder::Rgb),
            Some("bgr") => Some(ChannelOrder::Bgr),
            Some(other) => {
                return Err(Error::format(format!(
                    "inputs.image.colour of the model is {other:?}; it must be rgb or bgr"
                )));
            }
        };
        Ok(Self { mean: entry("mean").map(three).transpose()?, std, order })
    }

    /// Returns mean and standard deviation of red, green and blue, if both are stated.
    pub fn rgb_normalisation(&self) -> Option<[[f32; 3]; 2]> {
        let both = [self.mean?, self.std?];
        Some(both.map(|values| in_order(self.order.unwrap_or(ChannelOrder::Rgb), values)))
    }
}

fn three(numbers: &Value) -> Result<[f32; 3]> {
    let given: Option<Vec<f32>> =
        numbers.as_array().and_then(|all| all.iter().map(|one| one.as_f64().map(|one| one as f32)).collect());
    let three = given.and_then(|given| <[f32; 3]>::try_from(given).ok());
    three.filter(|three| three.iter().all(|number| number.is_finite())).ok_or_else(|| {
        Error::format(format!("inputs.image of the model has {numbers} instead of three numbers"))
    })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn three_numbers_are_three_numbers() {
        assert_eq!(three(&json!([1, 2.5, -3])).unwrap(), [1.0, 2.5, -3.0]);
        for wrong in
            [json!([1, 2]), json!("x"), json!([1, 2, null]), json!([1, 2, 3, 4]), json!([1e300, 0, 0])]
        {
            assert!(three(&wrong).unwrap_err().to_string().contains("three numbers"), "{wrong}");
        }
    }
}
