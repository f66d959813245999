//! Conventions of exported prompt decoders: what tools write, and by what it is recognised.

use opendr_inference::{ElementType, TensorInfo};
use opendr_perception_common::exported_network::Facts;

/// Name of the input that has the embeddings of the image.
pub(super) const IMAGE_EMBEDDINGS: &str = "image_embeddings";

/// What an input of a decoder is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Role {
    /// The output of the encoder with the same name.
    Embedding,
    /// Positions of points.
    Points,
    /// Labels of points.
    Labels,
    /// Logits of an earlier mask, and whether there is one: there is none.
    Mask,
    HasMask,
    /// Height and width of the image, for a mask of this size, which is not computed.
    ImageSize,
}

/// A form in which a tool exports the decoder of Segment Anything.
#[derive(Debug)]
pub(super) struct Convention {
    pub(super) inputs: &'static [(&'static str, Role)],
    /// Outputs of predicted IoUs and of logits.
    pub(super) scores: &'static str,
    pub(super) masks: &'static str,
    /// Number of dimensions before those of the points and masks of a prompt.
    pub(super) outer: usize,
    /// Whether a point without a meaning follows points without a box; else the network adds it.
    pub(super) pads: bool,
    /// Whether the corners of a box are points with labels of their own.
    pub(super) takes_boxes: bool,
    /// Whether the first of several masks is the one for unambiguous prompts.
    pub(super) has_single: bool,
}

/// Conventions, and the tools that write them.
const CONVENTIONS: [(&str, Convention); 3] = [
    (
        "segment-anything, MobileSAM",
        Convention {
            inputs: &[
                (IMAGE_EMBEDDINGS, Role::Embedding),
                ("point_coords", Role::Points),
                ("point_labels", Role::Labels),
                ("mask_input", Role::Mask),
                ("has_mask_input", Role::HasMask),
                ("orig_im_size", Role::ImageSize),
            ],
            scores: "iou_predictions",
            masks: "low_res_masks",
            outer: 1,
            pads: true,
            takes_boxes: true,
            has_single: true,
        },
    ),
    (
        "EdgeSAM",
        Convention {
            inputs: &[
                (IMAGE_EMBEDDINGS, Role::Embedding),
                ("point_coords", Role::Points),
                ("point_labels", Role::Labels),
            ],
            scores: "scores",
            masks: "masks",
            outer: 1,
            pads: true,
            takes_boxes: true,
            has_single: true,
        },
    ),
    (
        "transformers",
        Convention {
            inputs: &[
                (IMAGE_EMBEDDINGS, Role::Embedding),
                ("image_positional_embeddings", Role::Embedding),
                ("input_points", Role::Points),
                ("input_labels", Role::Labels),
            ],
            scores: "iou_scores",
            masks: "pred_masks",
            outer: 2,
            pads: false,
            takes_boxes: false,
            has_single: false,
        },
    ),
];

impl Convention {
    /// Recognises a decoder by the names of its inputs and outputs, and by their shapes.
    pub(super) fn of(facts: &Facts) -> Option<&'static Self> {
        CONVENTIONS.iter().map(|(_, convention)| convention).find(|convention| convention.fits(facts))
    }

    /// Returns a text that lists the inputs and outputs of all conventions.
    pub(super) fn describe_all() -> String {
        let texts = CONVENTIONS.each_ref().map(|(tool, convention)| {
            let names: Vec<_> = convention.inputs.iter().map(|(name, _)| *name).collect();
            let Convention { scores, masks, .. } = convention;
            format!("{tool}: inputs {}, outputs {scores}, {masks}", names.join(", "))
        });
        texts.join("; ")
    }

    /// Returns the role of an input.
    pub(super) fn role(&self, name: &str) -> Option<Role> {
        self.inputs.iter().find(|(known, _)| *known == name).map(|(_, role)| *role)
    }

    fn fits(&self, facts: &Facts) -> bool {
        let named = |name: &str, rank: usize| {
            let is = |output: &&TensorInfo| output.name == name && output.dims.len() == rank;
            facts.outputs.iter().any(|output| is(&output) && output.element_type == ElementType::F32)
        };
        facts.inputs.len() == self.inputs.len()
            && self.inputs.iter().all(|(name, _)| facts.inputs.iter().any(|input| input.name == *name))
            && facts.inputs.iter().all(|input| self.is_fit(input))
            && named(self.scores, self.outer + 1)
            && named(self.masks, self.outer + 3)
    }

    /// Returns whether type and number of dimensions of an input are those of its role.
    fn is_fit(&self, input: &TensorInfo) -> bool {
        let (rank, element) = (input.dims.len(), input.element_type);
        let is_float = element == ElementType::F32;
        match self.role(&input.name) {
            Some(Role::Embedding | Role::Mask) => is_float && rank == 4,
            Some(Role::Points) => is_float && rank == self.outer + 2,
            Some(Role::Labels) => (is_float || element == ElementType::I64) && rank == self.outer + 1,
            Some(Role::HasMask | Role::ImageSize) => is_float && rank == 1,
            None => false,
        }
    }
}
