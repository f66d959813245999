//! ONNX models: reading, writing, building and rewriting of graphs.
//!
//! Contents:
//! * [`model_from_bytes`] and [`bytes_from_model`]: ONNX files; [`proto`] has the messages of the format.
//! * [`Builder`]: construction of a graph from [`Operator`]s and [`GraphTensor`]s, with constant folding. Begin here to
//!   write one.
//! * [`passes`]: graph rewriting, such as [`passes::simplify`].
//! * [`Array`]: tensors with known elements.
//!
//! Models run in `opendr-inference`; other formats are converted in `opendr-import`, networks are quantised in
//! `opendr-optimize`.
//!
//! ```
//! use opendr_onnx::{Builder, ElementType, Operator, GraphTensor, bytes_from_model, model_from_bytes, model_from_graph};
//!
//! let mut graph = Builder::default();
//! let x = graph.input("x", ElementType::Float, vec![None, Some(3)], &["batch"]);
//! let (double, dims) = (Operator::new("Mul"), x.dims().to_vec());
//! let scaled = graph.add("scaled", double, &[&x, &GraphTensor::scalar(2.0)], ElementType::Float, dims)?;
//! graph.output("y", &scaled, "", &["batch"])?;
//! let bytes = bytes_from_model(&model_from_graph(graph.finish("example")));
//! let graph = model_from_bytes(&bytes)?.graph.unwrap_or_default();
//! assert_eq!(graph.node[0].op_type, "Mul");
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod array;
mod builder;
mod float_type;
mod fold;
mod graph_tensor;
mod model;
mod operator;
pub mod passes;
pub mod proto;

pub use array::{Array, Data, ElementType, element_count};
pub use builder::Builder;
pub use float_type::FloatType;
pub use fold::slice_range;
pub use graph_tensor::{Dim, GraphTensor};
pub use model::{bytes_from_model, model_from_bytes, model_from_graph};
pub use operator::Operator;
