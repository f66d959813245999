//! Networks that other tools exported to ONNX: what they state about themselves, their image input, and rows of candidates.
//!
//! A learner of such networks reads [`Facts`], recognises a convention of its own, lets parameters override it
//! ([`InputParams::settle`]), and runs the network with [`ExportedNetwork`]. What is neither recognised nor given is an error that names
//! the parameter.

mod class_names;
mod facts;
mod image_input;
mod input_params;
mod kind;
mod rows;

pub use class_names::class_names;
pub use facts::{Facts, is_integer, last_two, open_outputs};
pub use image_input::{ExportedNetwork, ImageInput, in_order};
pub use input_params::{InputColour, InputConvention, InputLevels, InputParams, InputResize};
pub use kind::{
    IMAGE_EMBEDDINGS, NetworkKind, TEXT_EMBEDDINGS, depth_output, embedding_output, heatmaps, is_class_map,
    is_class_scores, is_value_map, named_heatmaps, simcc_outputs,
};
pub use rows::{ClassScores, Rows, Selection, cells_of, decode_grid};
