//! Inference module: sessions over ONNX Runtime or the built-in runtime, one interface for both.

mod builtin;
mod measured;
mod onnx_header;
mod onnx_runtime;
mod protobuf;
mod runtime;
mod selection;
mod session;
mod tensor;
mod threads;

pub mod recording;
pub mod timing;

pub use builtin::Builtin;
pub use onnx_runtime::{OnnxRuntime, prefer_python};
pub use runtime::{Engine, Runtime, SessionOptions, Sink};
pub use selection::{default_runtime, describe, device, runtimes};
pub use session::Session;
pub use tensor::{Element, ElementType, MAX_RANK, TensorData, TensorInfo, TensorView};
pub use threads::{default_threads, with_threads};
