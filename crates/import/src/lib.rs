//! Turns TensorFlow.js graph models into ONNX, and reads, rewrites and writes ONNX models.
//!
//! [`onnx_from_tfjs`] takes the files of a TensorFlow.js graph model as packages carry them and gives an ONNX model
//! that runs in ONNX Runtime and in the built-in runtime: channels-first, with the transpositions, identities and shape
//! arithmetic of the original evaluated or folded away. How images are laid out at its inputs and outputs is one rule,
//! written there.
//!
//! [`onnx`] is what the importer writes with: the messages of the file format ([`onnx::proto`]), a graph builder that
//! evaluates what is known ([`onnx::Builder`]), and rewrites of finished graphs ([`onnx::passes`]).

pub mod onnx;
mod tfjs;

pub use tfjs::{ImportOptions, onnx_from_tfjs, onnx_from_tfjs_file, tfjs_weight_files};
