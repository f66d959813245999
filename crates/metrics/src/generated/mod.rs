//! Generated tables.

pub(crate) mod punctuation;
