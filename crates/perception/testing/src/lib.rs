//! What the tests of perception learners share: real models and data, and checks that every learner that trains passes.
//!
//! Families have this crate as a dev-dependency; no program has it. Begin with [`test_models::test_data`].
#![allow(clippy::unwrap_used)]

pub mod overfit;
pub mod promises;
pub mod test_models;
