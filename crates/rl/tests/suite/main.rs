//! Integration tests of this crate, in one program to save linking.

#![allow(clippy::unwrap_used)]

mod allocation;
mod hostile;
mod learner;
mod learning;
mod memory;
mod pictures;
mod prior_params;
mod priors;
mod resume;
mod stable_baselines3;
mod support;

#[global_allocator]
static ALLOCATOR: opendr_test_allocator::CountingAllocator = opendr_test_allocator::CountingAllocator;
