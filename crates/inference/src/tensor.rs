//! Borrowed tensors, the inputs and outputs of a session.

use std::fmt;

use opendr_engine::{Error, Result};

/// Maximum number of dimensions of a tensor.
pub const MAX_RANK: usize = 8;

/// Element type of a tensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ElementType {
    /// 32-bit float.
    F32,
    /// 32-bit integer.
    I32,
    /// 64-bit integer.
    I64,
    /// Unsigned byte.
    U8,
    /// Signed byte.
    I8,
    /// Boolean, one byte each.
    Bool,
}

impl ElementType {
    /// Returns the Rust name, e.g. `"f32"`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::U8 => "u8",
            Self::I8 => "i8",
            Self::Bool => "bool",
        }
    }
}

impl fmt::Display for ElementType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Borrowed elements of one type in row-major order (the last dimension varies fastest).
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum TensorData<'a> {
    /// 32-bit floats.
    F32(&'a [f32]),
    /// 32-bit integers.
    I32(&'a [i32]),
    /// 64-bit integers.
    I64(&'a [i64]),
    /// Unsigned bytes.
    U8(&'a [u8]),
    /// Signed bytes.
    I8(&'a [i8]),
    /// Booleans.
    Bool(&'a [bool]),
}

impl TensorData<'_> {
    /// Returns the element type.
    pub fn element_type(&self) -> ElementType {
        match self {
            Self::F32(_) => ElementType::F32,
            Self::I32(_) => ElementType::I32,
            Self::I64(_) => ElementType::I64,
            Self::U8(_) => ElementType::U8,
            Self::I8(_) => ElementType::I8,
            Self::Bool(_) => ElementType::Bool,
        }
    }

    /// Returns the number of elements.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(data) => data.len(),
            Self::I32(data) => data.len(),
            Self::I64(data) => data.len(),
            Self::U8(data) => data.len(),
            Self::I8(data) => data.len(),
            Self::Bool(data) => data.len(),
        }
    }

    /// Returns whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A Rust type of tensor elements.
pub trait Element: Copy + sealed::Sealed + 'static {
    /// The type as a value.
    const TYPE: ElementType;

    /// Wraps `elements` with their type.
    fn data_from_slice(elements: &[Self]) -> TensorData<'_>;

    /// Returns the elements when they have this type.
    fn slice_from_data(data: TensorData<'_>) -> Option<&[Self]>;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! elements {
    ($($rust:ty => $name:ident),* $(,)?) => {$(
        impl sealed::Sealed for $rust {}

        impl Element for $rust {
            const TYPE: ElementType = ElementType::$name;

            fn data_from_slice(elements: &[Self]) -> TensorData<'_> {
                TensorData::$name(elements)
            }

            fn slice_from_data(data: TensorData<'_>) -> Option<&[Self]> {
                match data {
                    TensorData::$name(elements) => Some(elements),
                    _ => None,
                }
            }
        }
    )*};
}

elements!(f32 => F32, i32 => I32, i64 => I64, u8 => U8, i8 => I8, bool => Bool);

/// A borrowed tensor: elements and their shape. Creating and copying a view does not allocate.
#[derive(Clone, Copy)]
pub struct TensorView<'a> {
    data: TensorData<'a>,
    dims: [usize; MAX_RANK],
    rank: usize,
}

impl<'a> TensorView<'a> {
    /// Creates a view of `elements`, in row-major order, with the shape `shape` (empty for a scalar).
    ///
    /// # Errors
    /// `InvalidInput` when the shape has more than [`MAX_RANK`] dimensions or does not match the number of elements.
    pub fn new<T: Element>(shape: &[usize], elements: &'a [T]) -> Result<Self> {
        let count = shape.iter().try_fold(1_usize, |count, &dim| count.checked_mul(dim));
        let rank = shape.len();
        let mut dims = [0; MAX_RANK];
        match dims.get_mut(..rank) {
            Some(dims) if count == Some(elements.len()) => dims.copy_from_slice(shape),
            Some(_) => {
                return Err(Error::invalid_input(format!(
                    "{} elements do not match a tensor of shape {shape:?}",
                    elements.len()
                )));
            }
            None => {
                return Err(Error::invalid_input(format!(
                    "shape {shape:?} has {rank} dimensions; a tensor has at most {MAX_RANK}"
                )));
            }
        }
        Ok(Self { data: T::data_from_slice(elements), dims, rank })
    }

    /// Returns the number of elements in each dimension, outermost first.
    pub fn shape(&self) -> &[usize] {
        &self.dims[..self.rank]
    }

    /// Returns the element type.
    pub fn element_type(&self) -> ElementType {
        self.data.element_type()
    }

    /// Returns the elements of any type.
    pub fn data(&self) -> TensorData<'a> {
        self.data
    }

    /// Returns the elements as `T`.
    ///
    /// # Errors
    /// `InvalidInput` when the tensor has another element type.
    pub fn values<T: Element>(&self) -> Result<&'a [T]> {
        T::slice_from_data(self.data).ok_or_else(|| {
            Error::invalid_input(format!(
                "the tensor has elements of type {}, not {}",
                self.element_type(),
                T::TYPE
            ))
        })
    }
}

impl fmt::Debug for TensorView<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{:?}", self.element_type(), self.shape())
    }
}

/// Declaration of an input or output of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TensorInfo {
    /// Name in the model.
    pub name: String,
    /// Element type.
    pub element_type: ElementType,
    /// Size of each dimension, `None` where it is open. Empty for a scalar, and where the model does not declare the
    /// number of dimensions.
    pub dims: Vec<Option<usize>>,
}

impl TensorInfo {
    /// Checks a tensor against this declaration.
    ///
    /// # Errors
    /// `InvalidInput` with the name of the tensor, its declaration and its actual shape and type.
    pub fn check(&self, tensor: &TensorView<'_>) -> Result<()> {
        let shape = tensor.shape();
        let dims_fit = || {
            shape.len() == self.dims.len()
                && shape
                    .iter()
                    .zip(&self.dims)
                    .all(|(&dim, wanted)| wanted.is_none_or(|wanted| wanted == dim))
        };
        let fits = tensor.element_type() == self.element_type && (self.dims.is_empty() || dims_fit());
        if fits {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "model input {self} received {tensor:?}; change the shape or type of the tensor"
        )))
    }
}

/// Writes the declaration, e.g. `images: f32[1, 3, ?, ?]`.
impl fmt::Display for TensorInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}[", self.name, self.element_type)?;
        for (index, dim) in self.dims.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            match dim {
                Some(dim) => write!(f, "{comma}{dim}")?,
                None => write!(f, "{comma}?")?,
            }
        }
        f.write_str("]")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_has_to_fit_the_elements() {
        let data = [0.0_f32; 12];
        let view = TensorView::new(&[1, 3, 2, 2], &data).unwrap();
        assert_eq!(view.shape(), [1, 3, 2, 2]);
        assert_eq!(view.values::<f32>().unwrap().len(), 12);
        assert!(view.values::<u8>().unwrap_err().to_string().contains("type f32, not u8"));
        assert!(TensorView::new(&[13], &data).is_err());
        assert!(TensorView::new(&[usize::MAX, usize::MAX], &data).is_err());
        assert!(TensorView::new(&[1; 9], &data[..1]).is_err());
        assert_eq!(TensorView::new(&[], &data[..1]).unwrap().shape(), &[] as &[usize]);
    }

    #[test]
    fn info_says_what_is_wrong() {
        let info = TensorInfo {
            name: "image".into(),
            element_type: ElementType::F32,
            dims: vec![Some(1), Some(3), None],
        };
        let data = [0.0_f32; 6];
        assert!(info.check(&TensorView::new(&[1, 3, 2], &data).unwrap()).is_ok());
        let error = info.check(&TensorView::new(&[1, 2, 3], &data).unwrap()).unwrap_err().to_string();
        assert!(error.contains("image: f32[1, 3, ?]") && error.contains("f32[1, 2, 3]"), "{error}");
        assert!(info.check(&TensorView::new(&[3, 2], &data).unwrap()).is_err());
        assert!(info.check(&TensorView::new(&[1, 3, 1], &[0_u8; 3]).unwrap()).is_err());
    }
}
