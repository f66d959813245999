//! ncnn's models: a text of layers (`.param`) and their weights (`.bin`).
//!
//! `param` reads the text, `weights` the numbers, each where its layer needs them. `trace` goes through the layers, which stand in
//! the order in which they compute; `operator` (`product`, where there are weights) says each in ONNX's terms. A tensor of
//! ncnn has no batch and one, two or three axes; in ONNX each has an axis of 1 in front.

mod import;
mod operator;
mod param;
mod product;
mod shape;
mod trace;
mod weights;

pub use import::{onnx_from_ncnn, onnx_from_ncnn_files};
