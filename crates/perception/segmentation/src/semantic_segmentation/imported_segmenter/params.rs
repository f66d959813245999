//! Parameters of [`super::ImportedSegmenter`].

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::InputParams;

opendr_engine::choices! {
    /// What a segmenter's output has for each pixel.
    pub enum MapFormat {
        /// Recognised from the shape of the output and that of the input.
        Auto = "auto",
        /// Scores of the classes, `[1, classes, height, width]`.
        ChannelsFirst = "channels_first",
        /// Scores of the classes, `[1, height, width, classes]`.
        ChannelsLast = "channels_last",
        /// The index of a class, `[1, height, width]`.
        Labels = "labels",
    }
}

/// Parameters of [`super::ImportedSegmenter`].
#[derive(Debug, Clone, Params)]
pub struct ImportedSegmenterParams {
    /// Whether the map has the size of the image, to which scores are interpolated before the class with the highest one is chosen; else
    /// it has that of the network's output.
    #[param(default = true, live)]
    pub full_size: bool,
    /// What the output has for each pixel.
    pub map: MapFormat,
    /// Name of the output; recognised from the network if absent.
    pub map_output: Option<String>,
    /// The network's input.
    #[param(flatten)]
    pub input: InputParams,
}
