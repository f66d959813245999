//! Tests of the crate that count allocations.
#![cfg(feature = "training")]
#![allow(clippy::unwrap_used)]

mod streams;

#[global_allocator]
static ALLOCATOR: opendr_test_allocator::CountingAllocator = opendr_test_allocator::CountingAllocator;
