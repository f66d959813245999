//! Graph executor: ONNX models planned and run on the CPU kernels.
//!
//! Contents:
//! * [`Executor`]: an opened model that runs on [`Tensor`]s. Begin here.
//! * [`supported_operators`]: the operators that it runs; a model with another one is refused when it is opened.
//!
//! A model is planned once per shape of its inputs: shapes are inferred, what depends on constants only is computed,
//! activations and sums are fused into convolutions, image tensors lie with channels last, and every tensor has a
//! place in one arena. A run then allocates nothing. Where a shape depends on the elements of a run, the graph is cut: what
//! comes after is planned when they are known. `opendr-inference` runs models through this crate.
//!
//! ```
//! use opendr_executor::{Data, Executor, Tensor};
//! use opendr_kernels::Compute;
//! use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
//!
//! let mut graph = Builder::default();
//! let x = graph.input("x", ElementType::Float, vec![Some(2)], &[]);
//! let relu = graph.add("relu", Operator::new("Relu"), &[&x], ElementType::Float, vec![Some(2)])?;
//! graph.output("y", &relu, "", &[])?;
//! let model = bytes_from_model(&model_from_graph(graph.finish("example")));
//!
//! let mut executor = Executor::open(&model, Compute::single())?;
//! executor.run(&[Tensor { shape: &[2], data: Data::F32(&[-1.0, 3.0]) }], &mut |outputs| {
//!     assert!(matches!(outputs[0].data, Data::F32([0.0, 3.0])));
//!     Ok(())
//! })?;
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod attributes;
mod constant;
mod control;
mod declared;
mod emit;
mod executor;
pub mod fuzzing;
mod graph;
mod io;
mod memory;
mod ops;
mod order;
mod plan;
mod planner;
mod planning;
mod reading;
mod remap;
mod run;
mod simplify;
mod stages;
mod subgraphs;
mod tensor;
mod value;

pub use executor::{Executor, LayerProfile};
pub use ops::supported_operators;
pub use tensor::{Data, Kind, Tensor};
