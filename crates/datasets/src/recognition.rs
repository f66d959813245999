//! Recognition of data set formats.

/// Whether a path is a data set of a format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Recognition {
    /// The path has files that no other format has.
    Certain,
    /// The path has files that other formats may have, too.
    Possible,
    /// The path is not of the format, with what is missing.
    No(String),
}
