//! Turns TensorFlow.js graph models into ONNX, and reads, rewrites and writes ONNX models.

pub mod onnx;
mod tfjs;

pub use tfjs::{ImportOptions, onnx_from_tfjs, onnx_from_tfjs_file, tfjs_weight_files};
