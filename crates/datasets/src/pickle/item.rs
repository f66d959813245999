//! Values of a pickle.

use crate::npy::NpyType;

/// Index of a value of a pickle.
pub(super) type Id = usize;

/// A value. Contained values are indices, so that shared values and cycles cost nothing.
#[derive(Debug, Clone)]
pub(super) enum Item {
    None,
    Whole(i64),
    Float(f64),
    Text(String),
    Bytes(Vec<u8>),
    List(Vec<Id>),
    Dictionary(Vec<(Id, Id)>),
    /// Module and name.
    Global(String, String),
    Type(NpyType, String),
    Array(Vec<usize>, NpyType, bool, Vec<u8>),
    /// An array that is not filled yet.
    Unfilled,
}
