//! Turns TensorFlow.js graph models into ONNX.
//!
//! [`onnx_from_tfjs`] takes the files of a TensorFlow.js graph model as packages carry them and gives an ONNX model
//! that runs in ONNX Runtime and in the built-in runtime: channels-first, with the transpositions, identities and shape
//! arithmetic of the original evaluated or folded away. How images are laid out at its inputs and outputs is one rule,
//! written there.

mod tfjs;

pub use tfjs::{ImportOptions, onnx_from_tfjs, onnx_from_tfjs_file, tfjs_weight_files};
