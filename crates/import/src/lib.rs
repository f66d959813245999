//! Turns models of other formats into ONNX.
//!
//! [`onnx_from_tfjs`] takes the files of a TensorFlow.js graph model as packages carry them, [`onnx_from_tflite`] a
//! `.tflite` file. Both give an ONNX model that runs in ONNX Runtime and in the built-in runtime: channels-first, with
//! the transpositions, identities and shape arithmetic of the original evaluated or folded away. How images are laid
//! out at its inputs and outputs is one rule, written there.
//!
//! [`onnx_from_ncnn`] takes the two files of a model of ncnn's, which has pictures channels-first already.
//!
//! [`onnx_from_whisper`] builds the two networks of a Whisper around weights from anywhere; those of CTranslate2 are read by
//! [`whisper_from_ctranslate2`], those of transformers by [`whisper_from_safetensors`], those of ONNX files by
//! [`whisper_from_onnx`]. [`SafetensorsFile`] serves weights of any
//! network.

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
