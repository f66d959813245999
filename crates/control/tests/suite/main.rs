//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used)]

mod learners;
mod online;
mod planar;
mod priors;

#[global_allocator]
static ALLOCATOR: opendr_test_allocator::CountingAllocator = opendr_test_allocator::CountingAllocator;
