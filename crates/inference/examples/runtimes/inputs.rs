//! Random inputs of a model.

use opendr_engine::{Random, Result};
use opendr_inference::{ElementType, TensorInfo, TensorView};

/// An input of its shape and type.
pub enum Owned {
    Floats(Vec<usize>, Vec<f32>),
    Longs(Vec<usize>, Vec<i64>),
    Ints(Vec<usize>, Vec<i32>),
    Bytes(Vec<usize>, Vec<u8>),
    SignedBytes(Vec<usize>, Vec<i8>),
    Truths(Vec<usize>, Vec<bool>),
}

impl Owned {
    /// Returns random numbers. Open dimensions have the size 256 where there is a height or width, else 8.
    pub fn random(info: &TensorInfo) -> Self {
        let open = |d: usize| match (info.dims.len(), d) {
            (_, 0) => 1,
            (4, _) => 256,
            _ => 8,
        };
        let shape: Vec<usize> =
            info.dims.iter().enumerate().map(|(d, dim)| dim.unwrap_or_else(|| open(d))).collect();
        let count = shape.iter().product();
        let mut random = Random::new(7);
        match info.element_type {
            ElementType::I64 => Self::Longs(shape, (0..count).map(|i| i as i64 % 7).collect()),
            ElementType::I32 => Self::Ints(shape, (0..count).map(|i| i as i32 % 7).collect()),
            ElementType::I8 => {
                Self::SignedBytes(shape, (0..count).map(|i| (i * 37 % 251) as u8 as i8).collect())
            }
            ElementType::U8 => Self::Bytes(shape, (0..count).map(|i| (i * 37 % 251) as u8).collect()),
            ElementType::Bool => Self::Truths(shape, (0..count).map(|i| i % 3 == 0).collect()),
            _ => Self::Floats(shape, (0..count).map(|_| random.uniform(-1.0, 1.0)).collect()),
        }
    }

    /// Returns the input for the graph executor, where it takes the type.
    pub fn of_executor(&self) -> Option<opendr_executor::Tensor<'_>> {
        use opendr_executor::{Data, Tensor};
        match self {
            Self::Floats(shape, data) => Some(Tensor { shape, data: Data::F32(data) }),
            Self::Longs(shape, data) => Some(Tensor { shape, data: Data::I64(data) }),
            Self::Ints(shape, data) => Some(Tensor { shape, data: Data::I32(data) }),
            Self::Bytes(shape, data) => Some(Tensor { shape, data: Data::U8(data) }),
            Self::SignedBytes(shape, data) => Some(Tensor { shape, data: Data::I8(data) }),
            Self::Truths(..) => None,
        }
    }

    /// Returns the input for a session.
    pub fn view(&self) -> Result<TensorView<'_>> {
        match self {
            Self::Floats(shape, data) => TensorView::new(shape, data),
            Self::Longs(shape, data) => TensorView::new(shape, data),
            Self::Ints(shape, data) => TensorView::new(shape, data),
            Self::Bytes(shape, data) => TensorView::new(shape, data),
            Self::SignedBytes(shape, data) => TensorView::new(shape, data),
            Self::Truths(shape, data) => TensorView::new(shape, data),
        }
    }
}
