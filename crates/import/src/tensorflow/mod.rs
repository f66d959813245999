//! What TensorFlow's operators mean in ONNX, whichever file they come from.
//!
//! A node of TensorFlow's graph is a `call`; its function in `ops` writes it through `lowering` into an ONNX graph. A
//! tensor on that way is a `value`: a tensor of the ONNX graph and the order in which it stores TensorFlow's axes
//! (`layout`), so that hardly any has to be transposed.

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
pub use output::{finish, wanted};
pub use value::Value;
