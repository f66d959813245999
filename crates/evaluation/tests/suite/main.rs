//! Tests of `opendr-evaluation` as its users call it.

mod evaluation;
mod permutations;
