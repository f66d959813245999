//! The C API: what `include/opendr.h` declares and `docs/c.md` explains.
//!
//! It knows types, never learners: these functions take any learner and any value; what the header has for one learner
//! or one type is made from the registry and the list of types (`tests/header`), `static inline`, over these.
//!
//! Every function checks what can be checked (null, wrong handles, lengths), catches panics, and answers a status. What
//! it cannot check, the caller promises: that pointers lead to as much memory as their lengths say, and that a handle is
//! not used after it was freed, or freed while another thread uses it.

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
