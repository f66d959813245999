//! Parameters of [`super::ImportedPromptableSegmenter`].

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::InputLevels;

opendr_engine::choices! {
    /// Which of the masks of a prompt is predicted. Segment Anything has several masks for ambiguous prompts, and a single one for others.
    pub enum MaskSelection {
        /// The best of several for one point, the single one for several points and for a box.
        Auto = "auto",
        /// Of several, the one with the highest predicted IoU.
        Best = "best",
        /// The single one.
        Single = "single",
    }
}

/// Parameters of [`super::ImportedPromptableSegmenter`].
#[derive(Debug, Clone, Params)]
pub struct ImportedPromptableSegmenterParams {
    /// Points of one object, in pixels of the image: `x,y` or `x,y,label` each, separated by semicolons, e.g. `320,240;100,80,0`. The
    /// label is 1 for a point on the object, as without a label, and 0 for one outside.
    #[param(live)]
    pub points: String,
    /// Predicted IoU below which masks are dropped.
    #[param(default = 0.0, range = 0.0..=1.0, live)]
    pub quality_threshold: f32,
    /// Logit above which pixels belong to the mask.
    #[param(default = 0.0, range = -50.0..=50.0, live)]
    pub mask_threshold: f32,
    /// Which of the masks of a prompt is predicted.
    pub multimask: MaskSelection,
    /// Range of the samples of the encoder's input.
    pub levels: InputLevels,
    /// Side of the encoder's input in pixels, for encoders of dynamic size; 1024 if absent.
    #[param(range = 32..=4096, unit = "px")]
    pub size: Option<usize>,
}
