//! TensorFlow.js graph models (`model.json` and weight files).
//!
//! `model_json` and `weights` read the files. `trace` walks the graph from its outputs and hands every node that they
//! need to its function in `ops`, which writes it through `lowering` into an ONNX graph. A tensor on that way is a
//! `value`: a tensor of the ONNX graph and the order in which it stores TensorFlow's axes (`layout`), so that hardly
//! any has to be transposed.

mod attributes;
mod call;
mod import;
mod layout;
mod lowering;
mod model_json;
mod ops;
mod options;
mod trace;
mod value;
mod weights;

pub use import::{onnx_from_tfjs, onnx_from_tfjs_file, tfjs_weight_files};
pub use options::ImportOptions;
