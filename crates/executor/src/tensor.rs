//! Element types, and tensors at the edge of the executor.

use opendr_engine::{Error, Result};
use opendr_kernels::{Arena, Region};
use opendr_onnx::proto::DataType;

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

    /// Returns whether it is the type of indices and sizes.
    pub(crate) fn is_index(self) -> bool {
        matches!(self, Self::I64 | Self::I32)
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

impl Tensor<'_> {
    /// A tensor of no elements, in the place of one that nothing reads.
    pub(crate) const EMPTY: Self = Self { shape: &[0], data: Data::U8(&[]) };
}

impl<'a> Data<'a> {
    /// Returns the elements of a region; `None` for 16-bit floats.
    pub(crate) fn read(kind: Kind, from: &'a Arena, region: Region) -> Option<Self> {
        Some(match kind {
            Kind::F32 => Self::F32(from.get(region)),
            Kind::I64 => Self::I64(from.get(region)),
            Kind::I32 => Self::I32(from.get(region)),
            Kind::U8 => Self::U8(from.get(region)),
            Kind::I8 => Self::I8(from.get(region)),
            Kind::Bool => Self::Bool(from.get(region)),
            Kind::F16 => return None,
        })
    }

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
