//! Tables that a program made.

pub(crate) mod punctuation;
