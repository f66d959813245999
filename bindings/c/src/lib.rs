//! C API of OpenDR: the library `libopendr` and its header `opendr.h`.
//!
//! The functions of this crate take any learner and any value; they depend on data and target types, never on single
//! learners. The functions for one learner or one type in `include/opendr.h` are `static inline` wrappers of these, generated
//! from the registry and the list of types (`tests/header`). The headers with OpenDR 3.0's names in `include/opendr` are
//! written by hand. `docs/c.md` explains the API, and `examples` has programs in C and C++.
//!
//! Every function checks its arguments as far as possible (null, wrong handles, lengths), catches panics, and returns a
//! status. The caller guarantees the rest: that pointers point to as much memory as their lengths state, and that a handle is
//! not used after it was freed, or freed while another thread uses it.
//!
//! Begin with [`opendr_load`] and [`opendr_infer`].

#![allow(non_camel_case_types, clippy::missing_safety_doc)]

mod compat;
mod data;
mod draw;
mod environment;
mod eval;
mod fit;
mod handle;
mod learner;
mod network;
mod pointer;
mod preprocess;
mod progress;
mod source;
mod status;
mod string;
mod target;
mod tensors;
mod texts;
mod value;

pub use compat::*;
pub use data::*;
pub use draw::*;
pub use environment::*;
pub use eval::*;
pub use fit::*;
pub use learner::*;
pub use network::*;
pub use preprocess::*;
pub use progress::*;
pub use source::*;
pub use status::*;
pub use string::*;
pub use target::*;
pub use tensors::*;
pub use value::*;
