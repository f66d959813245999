//! Sessions that run ONNX models on ONNX Runtime or the built-in runtime.
//!
//! Contents:
//! * [`Session`]: an opened model that runs on tensors. Begin here.
//! * [`TensorView`]: a borrowed tensor, input and output of a session; [`TensorInfo`]: a declared input or output.
//! * [`Runtime`] and [`Engine`]: the interface of runtimes, with [`OnnxRuntime`] and [`Builtin`].
//! * [`default_runtime`], [`device`] and [`describe`]: the choice of runtime and device.
//! * [`recording`], [`timing`] and [`layers`]: the inputs, the time and the layers of all sessions of a thread, for calibration
//!   and benchmarks.
//!
//! Models are read and rewritten in `opendr-onnx`, converted in `opendr-import`, quantised in `opendr-optimize`, and
//! downloaded in `opendr-zoo`.
//!
//! ```
//! use opendr_engine::Device;
//! use opendr_inference::{Builtin, Session, TensorView};
//! use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
//!
//! let mut graph = Builder::default();
//! let x = graph.input("x", ElementType::Float, vec![Some(2)], &[]);
//! let relu = graph.add("relu", Operator::new("Relu"), &[&x], ElementType::Float, vec![Some(2)])?;
//! graph.output("y", &relu, "", &[])?;
//! let model = bytes_from_model(&model_from_graph(graph.finish("example")));
//!
//! let session = Session::open_with(&Builtin, &model, Device::Cpu)?;
//! session.run(&[TensorView::new(&[2], &[-1.0_f32, 3.0])?], |outputs| {
//!     assert_eq!(outputs[0].values::<f32>()?, [0.0, 3.0]);
//!     Ok(())
//! })?;
//! # Ok::<(), opendr_engine::Error>(())
//! ```

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

pub mod layers;
pub mod recording;
pub mod timing;

pub use builtin::Builtin;
pub use onnx_header::declared_tensors;
pub use onnx_runtime::{OnnxRuntime, prefer_python};
pub use runtime::{Engine, Runtime, SessionOptions, Sink};
pub use selection::{default_runtime, describe, device, runtimes};
pub use session::Session;
pub use tensor::{Element, ElementType, MAX_RANK, TensorData, TensorInfo, TensorView};
pub use threads::{default_threads, with_threads};
