//! Tensors with known elements: weights, shapes and values that follow from them.

use opendr_engine::{Error, Result};

use super::proto::{DataType, TensorProto};

/// Returns the number of elements of a tensor of these dimensions; `None` when it overflows.
pub fn element_count(dims: &[usize]) -> Option<usize> {
    dims.iter().try_fold(1usize, |count, &dim| count.checked_mul(dim))
}

/// Element types of a graph under construction. All integer types become `Int`: ONNX requires int64 for shapes and
/// indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ElementType {
    /// `f32`.
    Float,
    /// `i64`.
    Int,
    /// `bool`.
    Bool,
}

impl ElementType {
    /// Returns ONNX's value of this element type.
    pub fn data_type(self) -> DataType {
        match self {
            Self::Float => DataType::Float,
            Self::Int => DataType::Int64,
            Self::Bool => DataType::Bool,
        }
    }
}

/// Elements in row-major order.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// 32-bit floats.
    Float(Vec<f32>),
    /// Integers.
    Int(Vec<i64>),
    /// Booleans.
    Bool(Vec<bool>),
    /// Signed quantised values, read by a `DequantizeLinear`.
    Int8(Vec<i8>),
    /// Unsigned quantised values, read by a `DequantizeLinear`.
    UInt8(Vec<u8>),
    /// Quantised sums, read by a `DequantizeLinear`.
    Int32(Vec<i32>),
    /// Integers of which only some are known: the shape of a tensor with open dimensions.
    Partial(Vec<Option<i64>>),
}

/// Evaluates one expression on the vector of any variant, and wraps the result in the same variant.
macro_rules! map_data {
    ($data:expr, $values:ident => $result:expr) => {
        match $data {
            Data::Float($values) => Data::Float($result),
            Data::Int($values) => Data::Int($result),
            Data::Bool($values) => Data::Bool($result),
            Data::Int8($values) => Data::Int8($result),
            Data::UInt8($values) => Data::UInt8($result),
            Data::Int32($values) => Data::Int32($result),
            Data::Partial($values) => Data::Partial($result),
        }
    };
}
pub(crate) use map_data;

impl Data {
    /// Returns the number of elements.
    pub fn len(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::Int(values) => values.len(),
            Self::Bool(values) => values.len(),
            Self::Int8(values) => values.len(),
            Self::UInt8(values) => values.len(),
            Self::Int32(values) => values.len(),
            Self::Partial(values) => values.len(),
        }
    }

    /// Returns whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the element type; the narrow integers count as integers.
    pub fn kind(&self) -> ElementType {
        match self {
            Self::Float(_) => ElementType::Float,
            Self::Int(_) | Self::Partial(_) | Self::Int8(_) | Self::UInt8(_) | Self::Int32(_) => {
                ElementType::Int
            }
            Self::Bool(_) => ElementType::Bool,
        }
    }

    /// Returns ONNX's value of the type in which the elements are written.
    pub(super) fn data_type(&self) -> DataType {
        match self {
            Self::Int8(_) => DataType::Int8,
            Self::UInt8(_) => DataType::Uint8,
            Self::Int32(_) => DataType::Int32,
            _ => self.kind().data_type(),
        }
    }
}

/// Returns the bytes of all values in order.
pub(crate) fn bytes_of<T: Copy, const N: usize>(values: &[T], bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().map(|value| bytes(*value)).collect::<Vec<_>>().into_flattened()
}

/// Dimensions and elements; the number of elements always matches the dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    dims: Vec<usize>,
    data: Data,
}

impl Array {
    /// Returns `None` when the number of elements does not match the dimensions.
    pub fn new(dims: Vec<usize>, data: Data) -> Option<Self> {
        (element_count(&dims) == Some(data.len())).then_some(Self { dims, data })
    }

    /// Creates a float tensor of rank 0.
    pub fn scalar(value: f32) -> Self {
        Self { dims: Vec::new(), data: Data::Float(vec![value]) }
    }

    /// Creates an integer tensor of rank 0.
    pub fn int(value: i64) -> Self {
        Self { dims: Vec::new(), data: Data::Int(vec![value]) }
    }

    /// Creates a list of integers, such as a shape or axes.
    pub fn ints(values: Vec<i64>) -> Self {
        Self { dims: vec![values.len()], data: Data::Int(values) }
    }

    /// Creates a list of integers of which some are unknown.
    pub fn partial(values: Vec<Option<i64>>) -> Self {
        Self { dims: vec![values.len()], data: Data::Partial(values) }.completed()
    }

    /// Returns the dimensions, outermost first.
    pub fn dims(&self) -> &[usize] {
        &self.dims
    }

    /// Returns the elements.
    pub fn data(&self) -> &Data {
        &self.data
    }

    /// Returns the elements for changes in place; their number must stay.
    pub(super) fn data_mut(&mut self) -> &mut Data {
        &mut self.data
    }

    /// Returns the element type.
    pub fn kind(&self) -> ElementType {
        self.data.kind()
    }

    /// Returns whether every element is known.
    pub fn is_complete(&self) -> bool {
        !matches!(self.data, Data::Partial(_))
    }

    /// Converts partial data without unknown elements to plain integers.
    #[must_use]
    pub fn completed(mut self) -> Self {
        if let Data::Partial(values) = &self.data
            && let Some(known) = values.iter().copied().collect::<Option<Vec<i64>>>()
        {
            self.data = Data::Int(known);
        }
        self
    }

    /// Returns the elements of a float tensor.
    pub fn as_floats(&self) -> Option<&[f32]> {
        match &self.data {
            Data::Float(values) => Some(values),
            _ => None,
        }
    }

    /// Returns the elements of an integer tensor, if all are known.
    pub fn as_ints(&self) -> Option<&[i64]> {
        match &self.data {
            Data::Int(values) => Some(values),
            _ => None,
        }
    }

    /// Returns the same elements with other dimensions; `None` when the number of elements does not match.
    pub fn reshaped(self, dims: Vec<usize>) -> Option<Self> {
        Self::new(dims, self.data)
    }

    /// Converts to an initializer of a graph.
    ///
    /// # Errors
    /// `Internal` for partial data, which cannot be written.
    pub fn to_tensor(&self, name: &str) -> Result<TensorProto> {
        let raw_data = match &self.data {
            Data::Float(values) => bytes_of(values, |value| value.to_le_bytes()),
            Data::Int(values) => bytes_of(values, |value| value.to_le_bytes()),
            Data::Bool(values) => values.iter().map(|&value| u8::from(value)).collect(),
            Data::Int8(values) => values.iter().map(|value| value.cast_unsigned()).collect(),
            Data::UInt8(values) => values.clone(),
            Data::Int32(values) => bytes_of(values, |value| value.to_le_bytes()),
            Data::Partial(_) => return Err(Error::internal(format!("shape {name:?} has unknown elements"))),
        };
        Ok(TensorProto {
            name: name.to_owned(),
            dims: self.dims.iter().map(|&dim| dim as i64).collect(),
            data_type: self.data.data_type() as i32,
            raw_data,
            ..TensorProto::default()
        })
    }

    /// Reads an initializer of type float, int64 or bool; `None` for other types and inconsistent tensors.
    pub fn from_tensor(tensor: &TensorProto) -> Option<Self> {
        let dims: Option<Vec<usize>> = tensor.dims.iter().map(|&dim| usize::try_from(dim).ok()).collect();
        let raw = &tensor.raw_data;
        let data = match DataType::try_from(tensor.data_type).ok()? {
            DataType::Float if raw.is_empty() => Data::Float(tensor.float_data.clone()),
            DataType::Float => {
                Data::Float(raw.as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect())
            }
            DataType::Int64 if raw.is_empty() => Data::Int(tensor.int64_data.clone()),
            DataType::Int64 => Data::Int(raw.as_chunks().0.iter().map(|&b| i64::from_le_bytes(b)).collect()),
            DataType::Bool if raw.is_empty() => {
                Data::Bool(tensor.int32_data.iter().map(|&value| value != 0).collect())
            }
            DataType::Bool => Data::Bool(raw.iter().map(|&byte| byte != 0).collect()),
            _ => return None,
        };
        Self::new(dims?, data)
    }
}
