//! Mapping of TensorFlow's operators to ONNX, independent of the file format.
//!
//! A node of a TensorFlow graph is a `call`; its function in `ops` writes it through `lowering` into an ONNX graph. A
//! tensor is a `value`: a tensor of the ONNX graph and the order in which it stores TensorFlow's axes (`layout`), so
//! that few tensors are transposed.

mod attributes;
mod call;
mod input;
mod layout;
mod lowering;
pub mod ops;
mod options;
mod output;
mod value;

pub use attributes::{Attribute, Attributes};
pub use call::Call;
pub use input::input;
pub use layout::Order;
pub use lowering::{Lowering, MAX_RANK};
pub use options::ImportOptions;
pub use output::{finish, selected_outputs};
pub use value::Value;
