//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used)]

mod allocation;
mod best_view;
mod camera_policies;
mod learner;
mod learning;
mod rigs;
mod small;
mod toy;

#[global_allocator]
static ALLOCATOR: opendr_test_allocator::CountingAllocator = opendr_test_allocator::CountingAllocator;
