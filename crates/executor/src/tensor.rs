//! Element types, and tensors at the edge of the executor.

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Region};
use opendr_onnx::proto::{DataType, TensorProto};

/// Element type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// 32-bit float.
    F32,
    /// 64-bit integer.
    I64,
    /// 32-bit integer.
    I32,
    /// Unsigned byte.
    U8,
    /// Signed byte.
    I8,
    /// Boolean: a byte that is 0 or 1.
    Bool,
    /// 16-bit float, of constants only.
    F16,
}

impl Kind {
    /// Returns the bytes of an element.
    pub fn bytes(self) -> usize {
        match self {
            Self::I64 => 8,
            Self::F32 | Self::I32 => 4,
            Self::F16 => 2,
            Self::U8 | Self::I8 | Self::Bool => 1,
        }
    }

    pub(crate) fn from_onnx(kind: i32, name: &str) -> Result<Self> {
        Ok(match DataType::try_from(kind) {
            Ok(DataType::Float) => Self::F32,
            Ok(DataType::Int64) => Self::I64,
            Ok(DataType::Int32) => Self::I32,
            Ok(DataType::Uint8) => Self::U8,
            Ok(DataType::Int8) => Self::I8,
            Ok(DataType::Bool) => Self::Bool,
            Ok(DataType::Float16) => Self::F16,
            _ => {
                return Err(Error::unsupported(format!(
                    "the executor does not support ONNX type {kind} ({name:?})"
                )));
            }
        })
    }
}

/// A borrowed tensor in row-major order.
#[derive(Debug, Clone, Copy)]
pub struct Tensor<'a> {
    /// Number of elements in each dimension.
    pub shape: &'a [usize],
    /// Elements.
    pub data: Data<'a>,
}

/// Borrowed elements.
#[derive(Debug, Clone, Copy)]
pub enum Data<'a> {
    /// 32-bit floats.
    F32(&'a [f32]),
    /// 64-bit integers.
    I64(&'a [i64]),
    /// 32-bit integers.
    I32(&'a [i32]),
    /// Unsigned bytes.
    U8(&'a [u8]),
    /// Signed bytes.
    I8(&'a [i8]),
    /// Booleans: bytes that are 0 or 1.
    Bool(&'a [u8]),
}

impl Data<'_> {
    /// Returns the element type.
    pub fn kind(&self) -> Kind {
        match self {
            Self::F32(_) => Kind::F32,
            Self::I64(_) => Kind::I64,
            Self::I32(_) => Kind::I32,
            Self::U8(_) => Kind::U8,
            Self::I8(_) => Kind::I8,
            Self::Bool(_) => Kind::Bool,
        }
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Self::F32(data) => data.len(),
            Self::I64(data) => data.len(),
            Self::I32(data) => data.len(),
            Self::U8(data) | Self::Bool(data) => data.len(),
            Self::I8(data) => data.len(),
        }
    }
}

/// Maximum number of elements of a tensor.
const MAX_ELEMENTS: usize = 1 << 30;

/// Returns the number of elements.
///
/// # Errors
/// `Format` when it is too large for any memory.
pub(crate) fn count(shape: &[usize]) -> Result<usize> {
    let count = shape.iter().try_fold(1_usize, |count, &dim| count.checked_mul(dim));
    count.filter(|&count| count <= MAX_ELEMENTS).ok_or_else(|| {
        Error::format(format!("the ONNX model has a tensor of shape {shape:?}, too large for memory"))
    })
}

/// A tensor that is known before any run.
#[derive(Debug)]
pub(crate) struct Constant {
    pub(crate) kind: Kind,
    pub(crate) shape: Vec<usize>,
    pub(crate) data: Arena,
}

impl Constant {
    pub(crate) fn region(&self) -> Region {
        Region { start: 0, bytes: self.shape.iter().product::<usize>() * self.kind.bytes() }
    }

    pub(crate) fn floats(&self) -> Option<&[f32]> {
        (self.kind == Kind::F32).then(|| self.data.get(self.region()))
    }

    pub(crate) fn ints(&self) -> Option<Vec<i64>> {
        match self.kind {
            Kind::I64 => Some(self.data.get::<i64>(self.region()).to_vec()),
            Kind::I32 => {
                Some(self.data.get::<i32>(self.region()).iter().map(|&value| i64::from(value)).collect())
            }
            _ => None,
        }
    }

    pub(crate) fn from_ints(shape: Vec<usize>, values: &[i64]) -> Self {
        Self { kind: Kind::I64, shape, data: Arena::from_numbers(values) }
    }

    pub(crate) fn from_floats(shape: Vec<usize>, values: &[f32]) -> Self {
        Self { kind: Kind::F32, shape, data: Arena::from_numbers(values) }
    }

    /// Reads an initializer.
    pub(crate) fn from_tensor(tensor: &TensorProto) -> Result<Self> {
        let name = &tensor.name;
        if !tensor.external_data.is_empty() || tensor.data_location != 0 {
            return Err(Error::unsupported(format!(
                "the ONNX model keeps its weights {name:?} in another file; save it as one file"
            )));
        }
        let damaged = || {
            Error::format(format!(
                "damaged ONNX model: the size of the weights {name:?} does not match their shape"
            ))
        };
        let kind = Kind::from_onnx(tensor.data_type, name)?;
        let dims = tensor.dims.iter().map(|&dim| usize::try_from(dim).ok()).collect::<Option<Vec<_>>>();
        let shape = dims.ok_or_else(damaged)?;
        let elements = count(&shape)?;
        let raw = &tensor.raw_data;
        let data = if !raw.is_empty() {
            if raw.len() != elements * kind.bytes() {
                return Err(damaged());
            }
            match kind {
                Kind::F32 => Arena::from_numbers(
                    &raw.as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect::<Vec<_>>(),
                ),
                Kind::I64 => Arena::from_numbers(
                    &raw.as_chunks().0.iter().map(|&b| i64::from_le_bytes(b)).collect::<Vec<_>>(),
                ),
                Kind::I32 => Arena::from_numbers(
                    &raw.as_chunks().0.iter().map(|&b| i32::from_le_bytes(b)).collect::<Vec<_>>(),
                ),
                Kind::F16 => Arena::from_numbers(
                    &raw.as_chunks().0.iter().map(|&b| u16::from_le_bytes(b)).collect::<Vec<_>>(),
                ),
                Kind::Bool => Arena::from_numbers(&raw.iter().map(|&b| u8::from(b != 0)).collect::<Vec<_>>()),
                Kind::U8 | Kind::I8 => Arena::from_numbers(raw),
            }
        } else {
            let ints = &tensor.int32_data;
            let length = match kind {
                Kind::F32 => tensor.float_data.len(),
                Kind::I64 => tensor.int64_data.len(),
                _ => ints.len(),
            };
            if length != elements {
                return Err(damaged());
            }
            match kind {
                Kind::F32 => Arena::from_numbers(&tensor.float_data),
                Kind::I64 => Arena::from_numbers(&tensor.int64_data),
                Kind::I32 => Arena::from_numbers(ints),
                Kind::F16 => Arena::from_numbers(&ints.iter().map(|&value| value as u16).collect::<Vec<_>>()),
                Kind::Bool => {
                    Arena::from_numbers(&ints.iter().map(|&value| u8::from(value != 0)).collect::<Vec<_>>())
                }
                Kind::U8 | Kind::I8 => {
                    Arena::from_numbers(&ints.iter().map(|&value| value as u8).collect::<Vec<_>>())
                }
            }
        };
        Ok(Self { kind, shape, data })
    }
}
