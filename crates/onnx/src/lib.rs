//! ONNX models: reading and writing them, building graphs, rewriting graphs.

mod array;
mod builder;
mod float_type;
mod fold;
mod half;
mod model;
mod operator;
pub mod passes;
pub mod proto;
mod wire;

pub use array::{Array, Data, Kind, element_count};
pub use builder::Builder;
pub use float_type::FloatType;
pub use fold::slice_range;
pub use half::{float_from_half, half_from_float};
pub use model::{bytes_from_model, model_from_bytes, model_from_graph};
pub use operator::Operator;
pub use wire::{Dim, Wire};
