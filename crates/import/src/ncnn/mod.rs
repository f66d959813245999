//! Import of ncnn models: a text of layers (`.param`) and their weights (`.bin`).
//!
//! `param` parses the text, `weights` reads the weights in the order of the layers. `convert` converts the layers in
//! order of execution into a `trace`; `operator` (`product` for layers with weights) maps each to ONNX operators. A tensor of ncnn
//! has no batch and one, two or three axes; in ONNX it has an additional first axis of size 1.

mod activation;
mod convert;
mod import;
mod operator;
mod param;
mod product;
mod shape;
mod trace;
mod weights;

pub use import::{onnx_from_ncnn, onnx_from_ncnn_files};
