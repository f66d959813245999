//! Arrays of numbers, the payload of most data.

use std::fmt;
use std::sync::Arc;

use crate::numpy_text::{Number, array_str};
use crate::{Error, Result};

/// An array of `D` axes in row-major order. Clones share the numbers. `Display` prints it as NumPy does.
#[derive(Debug, Clone, PartialEq)]
pub struct Array<const D: usize> {
    data: Arc<Vec<f32>>,
    shape: [usize; D],
}

impl<const D: usize> Array<D> {
    /// Creates an array over `data` in row-major order.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the length of `data` is not the product of `shape`.
    pub fn new(data: impl Into<Arc<Vec<f32>>>, shape: [usize; D]) -> Result<Self> {
        let data = data.into();
        let expected = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if expected != Some(data.len()) {
            let count = data.len();
            return Err(Error::invalid_input(format!(
                "an array of shape {shape:?} cannot have {count} numbers; give one per element"
            )));
        }
        Ok(Self { data, shape })
    }

    /// Returns the size of each axis.
    pub fn shape(&self) -> [usize; D] {
        self.shape
    }

    /// Returns the number of elements.
    pub fn len(&self) -> usize {
        self.data.len()
    }

    /// Returns whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Returns the elements in row-major order.
    pub fn as_slice(&self) -> &[f32] {
        &self.data
    }

    /// Returns the elements for modification; copies them first if a clone shares them.
    pub fn make_mut(&mut self) -> &mut [f32] {
        let data: &mut Vec<f32> = Arc::make_mut(&mut self.data);
        data
    }

    /// Returns the elements at `index` of the first axis: a point of a cloud, an instant of a time series.
    pub fn part(&self, index: usize) -> Option<&[f32]> {
        let size = self.shape.get(1..)?.iter().product::<usize>();
        let start = index.checked_mul(size)?;
        (index < self.shape[0]).then(|| self.data.get(start..start + size)).flatten()
    }

    /// Returns the buffer, for sources that reuse it.
    pub fn into_data(self) -> Arc<Vec<f32>> {
        self.data
    }
}

impl<const D: usize> fmt::Display for Array<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&array_str(&self.shape, &|at| Number::F32(self.data[at])))
    }
}

/// Defines a datum that is a non-empty [`Array`] with a header.
macro_rules! array_datum {
    ($(#[$doc:meta])* $name:ident, $axes:literal, $empty:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            /// Time stamp and coordinate frame.
            pub header: $crate::Header,
            array: $crate::data::Array<$axes>,
        }

        impl $name {
            /// Creates a datum over `data` in row-major order.
            ///
            /// # Errors
            /// Returns `InvalidInput` if `data` is empty or its length is not the product of `shape`.
            pub fn new(data: impl Into<std::sync::Arc<Vec<f32>>>, shape: [usize; $axes]) -> $crate::Result<Self> {
                let array = $crate::data::Array::new(data, shape)?;
                if array.is_empty() {
                    return Err($crate::Error::invalid_input($empty));
                }
                Ok(Self { header: $crate::Header::default(), array })
            }

            /// Sets the header.
            #[must_use]
            pub fn with_header(mut self, header: $crate::Header) -> Self {
                self.header = header;
                self
            }

            /// Returns the array.
            pub fn array(&self) -> &$crate::data::Array<$axes> {
                &self.array
            }

            /// Returns the size of each axis.
            pub fn shape(&self) -> [usize; $axes] {
                self.array.shape()
            }

            /// Returns the elements in row-major order.
            pub fn as_slice(&self) -> &[f32] {
                self.array.as_slice()
            }

            /// Returns the array without the header.
            pub fn into_array(self) -> $crate::data::Array<$axes> {
                self.array
            }
        }

        impl $crate::data::Data for $name {}

        /// Writes OpenDR's text: the array as NumPy prints it; with `{:#}`, type and shape.
        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                if f.alternate() {
                    return $crate::data::write_shape(stringify!($name), &self.shape(), f);
                }
                self.array.fmt(f)
            }
        }
    };
}

pub(super) use array_datum;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_and_numbers_agree() {
        let mut array = Array::new(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [3, 2]).unwrap();
        assert_eq!(array.part(2), Some(&[5.0, 6.0][..]));
        assert_eq!(array.part(3), None);
        assert_eq!(array.part(usize::MAX), None);
        assert_eq!(array.to_string(), "[[1. 2.]\n [3. 4.]\n [5. 6.]]");
        let kept = array.clone();
        array.make_mut()[0] = 9.0;
        assert_eq!((kept.as_slice()[0], array.as_slice()[0]), (1.0, 9.0));
        assert!(Array::new(vec![1.0; 5], [3, 2]).is_err());
        assert!(Array::new(vec![], [usize::MAX, 2]).is_err());
    }
}
