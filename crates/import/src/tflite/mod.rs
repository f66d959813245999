//! Import of TensorFlow Lite models (`.tflite`).
//!
//! `flatbuffer` reads the bytes, `model` the required tables of the format. `convert` converts the operators
//! into a `trace`; `operator` (`product` for operators with weights) maps each to TensorFlow's operators, from which it differs
//! mostly in the storage of parameters and weights. Quantised tensors (`quantisation`) are real numbers in between,
//! rounded where the original rounds.
//!
//! The reader is written by hand: the format's own library either reads a file unchecked or checks all of it by a
//! schema of which few tables are needed, and neither limits how often a file may refer to the same bytes.

mod convert;
mod element;
mod flatbuffer;
mod import;
mod model;
mod names;
mod operator;
mod options;
mod product;
mod quantisation;
mod step;
mod trace;
mod window;

pub use import::{onnx_from_tflite, onnx_from_tflite_file};
