//! Vectors of features.

use std::sync::Arc;

use crate::data::array::array_datum;

array_datum! {
    /// A vector: features, a state, an embedding.
    Vector, 1, "Vector is empty"
}

impl Vector {
    /// Creates a vector of all of `data`.
    ///
    /// # Errors
    /// Returns `InvalidInput` if `data` is empty.
    pub fn from_data(data: impl Into<Arc<Vec<f32>>>) -> crate::Result<Self> {
        let data = data.into();
        let shape = [data.len()];
        Self::new(data, shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_those_of_opendr() {
        let vector = Vector::from_data(vec![1.0, 2.5]).unwrap();
        assert_eq!(vector.to_string(), "[1.  2.5]");
        assert_eq!(format!("{vector:#}"), "Vector of shape 2\n");
        assert_eq!(Vector::from_data(vec![]).unwrap_err().to_string(), "Vector is empty");
    }
}
