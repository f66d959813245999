//! Networks of embeddings, which the cosine compares: of faces (ArcFace, MobileFace) and of persons (OSNet).
//!
//! The zoo's models state the normalisation of their input in the manifest. A network of another tool states nothing; its
//! normalisation is given by parameters, and an error names those that are missing.

use opendr_engine::data::Image;
use opendr_engine::data::ImageView;
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Result};
use opendr_vision::{ChannelOrder, Preprocess, Similarity};

use crate::exported_network::{InputColour, InputLevels, in_order};
use crate::image_network::{FILE, ImageNetwork, preprocess_from_input};
use crate::manifest_preprocess::StatedInput;

/// Parameters of the input of a network of embeddings.
#[derive(Debug, Clone, Params)]
pub struct EmbeddingInputParams {
    /// Order of the colour channels of the network's input; `auto` is that of the model's manifest.
    pub colour: InputColour,
    /// Range of the samples of the network's input; `auto` is that of the model's manifest.
    pub levels: InputLevels,
}

/// A network of one image as input and one vector as output.
pub struct EmbeddingNetwork {
    network: ImageNetwork,
    length: usize,
}

impl EmbeddingNetwork {
    /// Opens the container's network. Parameters take the place of what the manifest states.
    ///
    /// # Errors
    /// `Unsupported` when neither parameters nor manifest give the normalisation; `Format` for a network whose input is not one image of
    /// a fixed size, or whose output is not one vector of a fixed length.
    pub fn open(model: &Model, params: &EmbeddingInputParams, device: Device) -> Result<Self> {
        let stated = StatedInput::of(model)?;
        let network = ImageNetwork::open_file(model, FILE, device, |input| {
            preprocess(preprocess_from_input(input)?, &stated, params)
        })?;
        let length = match network.outputs() {
            [output] => output.dims.last().copied().flatten().filter(|length| *length > 0),
            _ => None,
        };
        let length = length.ok_or_else(|| {
            let outputs: Vec<String> = network.outputs().iter().map(ToString::to_string).collect();
            Error::format(format!(
                "a network of embeddings has one output, a vector of a fixed length; this one has {}",
                outputs.join(", ")
            ))
        })?;
        Ok(Self { network, length })
    }

    /// Returns the length of an embedding.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Returns width and height of the network's input.
    pub fn size(&self) -> [usize; 2] {
        self.network.size()
    }

    /// Appends the embedding of a whole image, scaled to length 1; zeros for an embedding of length 0.
    ///
    /// # Errors
    /// The error of the network.
    pub fn embed(&self, image: ImageView<'_>, embeddings: &mut Vec<f32>) -> Result<()> {
        let begin = embeddings.len();
        self.network.run_sized(image, self.size(), |outputs, _| {
            embeddings.extend_from_slice(outputs[0].values::<f32>()?);
            Ok(())
        })?;
        self.finish(begin, embeddings).map(|_| ())
    }

    /// Replaces `embedding` by that of the part of an image that `crop` covers, scaled to length 1; returns whether it has a length.
    ///
    /// # Errors
    /// The error of the network.
    pub fn embed_crop(&self, image: &Image, crop: &Similarity, embedding: &mut Vec<f32>) -> Result<bool> {
        embedding.clear();
        self.network.run_crop(image, crop, |outputs| {
            embedding.extend_from_slice(outputs[0].values::<f32>()?);
            Ok(())
        })?;
        self.finish(0, embedding)
    }

    fn finish(&self, begin: usize, embeddings: &mut [f32]) -> Result<bool> {
        let embedding = &mut embeddings[begin..];
        if embedding.len() != self.length {
            return Err(Error::format(format!(
                "the network computed {} numbers for one image, not {}",
                embedding.len(),
                self.length
            )));
        }
        Ok(normalise(embedding))
    }
}

/// Scales a vector to length 1; returns `false` and fills it with zeros if it has no direction.
pub fn normalise(vector: &mut [f32]) -> bool {
    let length = vector.iter().map(|value| value * value).sum::<f32>().sqrt();
    let has_direction = length.is_normal();
    vector.iter_mut().for_each(|value| *value = if has_direction { *value / length } else { 0.0 });
    has_direction
}

fn preprocess(base: Preprocess, stated: &StatedInput, params: &EmbeddingInputParams) -> Result<Preprocess> {
    let order = match params.colour {
        InputColour::Auto => stated.order,
        InputColour::Rgb => Some(ChannelOrder::Rgb),
        InputColour::Bgr => Some(ChannelOrder::Bgr),
    };
    let levels = match params.levels {
        InputLevels::Auto => stated.rgb_normalisation(),
        levels => Some(<[_; 2]>::from(levels.mean_and_std())),
    };
    let missing = [("colour", order.is_none()), ("levels", levels.is_none())];
    let missing: Vec<&str> = missing.iter().filter(|(_, is)| *is).map(|(name, _)| *name).collect();
    let (Some(order), Some(levels)) = (order, levels) else {
        return Err(Error::unsupported(format!(
            "the network does not state how its input was normalised in training; set {}",
            missing.join(" and ")
        )));
    };
    let [mean, std] = levels.map(|values| in_order(order, values));
    Ok(base.order(order).normalise(mean, std))
}
