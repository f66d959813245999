//! What learners answer. One file per type.

mod action;

pub use action::{Action, ActionBase};
