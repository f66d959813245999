//! Shared test code of the perception learners.
//!
//! The crate has real models and data for tests ([`test_models`]), the check that a learner overfits one batch
//! ([`overfit`]), the image of the fixtures of exported networks ([`fixture_image`]), and the checks of the learner's contract
//! ([`learner_checks`]), damaged files ([`mutations`]), and a stop of a training ([`stop_at`]). It is a dev-dependency of the families only; no
//! program contains it. Begin with [`test_models::test_data`].
#![allow(clippy::unwrap_used)]

pub mod fixture_image;
pub mod learner_checks;
pub mod mutations;
pub mod overfit;
pub mod stop_at;
pub mod test_models;
