//! TensorFlow.js graph models (`model.json` and weight files).

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
