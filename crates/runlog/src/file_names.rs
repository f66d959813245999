//! Names of the files of a log.

/// Table of the scalars.
pub(crate) const TABLE: &str = "log.csv";
/// Curves of the scalars.
pub(crate) const CURVES: &str = "curves.svg";
