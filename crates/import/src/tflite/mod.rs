//! TensorFlow Lite models (`.tflite`).
//!
//! `flatbuffer` reads the bytes, `model` the few tables of the format that matter. `trace` goes through the operators;
//! `operator` (and `product`, where there are weights) says each in TensorFlow's terms, as the file's own differ in little more than how parameters and weights
//! are stored. Quantised tensors (`quantisation`) are real numbers on the way, rounded where the original rounds.
//!
//! The reader is written out here: the format's own library reads a file unchecked or checks all of it by a schema of
//! which a handful of tables are needed, and neither bounds how often a file may refer to the same bytes.

mod element;
mod flatbuffer;
mod import;
mod model;
mod names;
mod operator;
mod options;
mod product;
mod quantisation;
mod trace;
mod window;

pub use import::{onnx_from_tflite, onnx_from_tflite_file};
