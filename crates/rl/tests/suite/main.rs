//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used)]

mod allocation;
mod hostile;
mod learner;
mod learning;
mod memory;
mod pictures;
mod priors;
mod resume;
mod stable_baselines3;
mod support;

#[global_allocator]
static ALLOCATOR: opendr_test_allocator::Counting = opendr_test_allocator::Counting;
