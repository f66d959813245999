//! Import of TensorFlow.js, TensorFlow Lite, ncnn and Whisper models into ONNX.
//!
//! Contents:
//! * [`onnx_from_tfjs`] and [`onnx_from_tflite`]: TensorFlow models, converted to channels-first, with the
//!   transpositions and shape arithmetic of the original folded away. The functions document the layout of inputs and
//!   outputs.
//! * [`onnx_from_ncnn`]: ncnn's layers and weights.
//! * [`onnx_from_whisper`]: the two networks of a Whisper from a [`WhisperWeights`]. [`whisper_from_ctranslate2`],
//!   [`whisper_from_safetensors`] and [`whisper_from_onnx`] read weight files.
//! * [`SafetensorsFile`]: reading of safetensors. [`ImportOptions`]: image size and choice of outputs.
//!
//! The ONNX models run in `opendr-inference` on ONNX Runtime and on the built-in runtime. PyTorch weights for
//! training are imported in `opendr-training`.
//!
//! ```
//! use opendr_import::{ImportOptions, onnx_from_ncnn};
//!
//! let param = b"7767517\n2 2\nInput in 0 1 in 0=4 1=4 2=3\nReLU act 1 1 in out\n";
//! let onnx = onnx_from_ncnn(param, &[], &ImportOptions::default())?;
//! assert!(!onnx.is_empty());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod bounded;
mod ctranslate2;
mod ncnn;
mod safetensors;
mod tensorflow;
mod tfjs;
mod tflite;
mod whisper;

pub use ctranslate2::whisper_from_ctranslate2;
pub use ncnn::{onnx_from_ncnn, onnx_from_ncnn_files};
pub use safetensors::{FloatTensor, SafetensorsFile, whisper_from_safetensors};
pub use tensorflow::ImportOptions;
pub use tfjs::{onnx_from_tfjs, onnx_from_tfjs_file, tfjs_weight_files};
pub use tflite::{onnx_from_tflite, onnx_from_tflite_file};
pub use whisper::{WhisperOnnx, WhisperWeights, is_exported_whisper, onnx_from_whisper, whisper_from_onnx};
