//! Import of TensorFlow.js graph models (`model.json` and weight files).
//!
//! `model_json`, `attributes` and `weights` read the files. `trace` walks the graph from its outputs and lowers every
//! required node with TensorFlow's operators.

mod attributes;
mod import;
mod model_json;
mod trace;
mod weights;

pub use import::{onnx_from_tfjs, onnx_from_tfjs_file, tfjs_weight_files};
