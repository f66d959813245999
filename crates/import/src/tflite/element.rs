//! Element types of tensors, and decoding of elements.

use half::f16;
use opendr_engine::{Error, Result};
use opendr_onnx::{Data, ElementType};

/// Element types, with the numbers of the file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Element {
    Float32,
    Float16,
    Int32,
    UInt8,
    Int64,
    Bool,
    Int16,
    Int8,
    /// An unknown type, by its number.
    Other(u8),
}

impl From<u8> for Element {
    fn from(number: u8) -> Self {
        match number {
            0 => Self::Float32,
            1 => Self::Float16,
            2 => Self::Int32,
            3 => Self::UInt8,
            4 => Self::Int64,
            6 => Self::Bool,
            7 => Self::Int16,
            9 => Self::Int8,
            number => Self::Other(number),
        }
    }
}

impl Element {
    /// Returns the element type in the ONNX graph.
    ///
    /// # Errors
    /// `Unsupported` for strings, complex numbers and 4-bit numbers.
    pub fn kind(self) -> Result<ElementType> {
        match self {
            Self::Float32 | Self::Float16 => Ok(ElementType::Float),
            Self::Int32 | Self::UInt8 | Self::Int64 | Self::Int16 | Self::Int8 => Ok(ElementType::Int),
            Self::Bool => Ok(ElementType::Bool),
            Self::Other(number) => {
                Err(Error::unsupported(format!("a tensor has the unsupported element type {number}")))
            }
        }
    }

    /// Returns the bytes per element.
    ///
    /// # Errors
    /// Those of [`Element::kind`].
    pub fn width(self) -> Result<usize> {
        match self {
            Self::UInt8 | Self::Bool | Self::Int8 => Ok(1),
            Self::Float16 | Self::Int16 => Ok(2),
            Self::Float32 | Self::Int32 => Ok(4),
            Self::Int64 => Ok(8),
            Self::Other(_) => self.kind().map(|_| 0),
        }
    }

    /// Decodes elements. Quantised ones keep their stored width.
    pub fn decode(self, bytes: &[u8], quantised: bool) -> Data {
        let ints = |values: &mut dyn Iterator<Item = i64>| Data::Int(values.collect());
        let words = bytes.as_chunks().0.iter();
        match (self, quantised) {
            (Self::Float32, _) => Data::Float(words.map(|&word| f32::from_le_bytes(word)).collect()),
            (Self::Float16, _) => {
                let halves = bytes.as_chunks().0.iter();
                Data::Float(halves.map(|&half| f16::from_le_bytes(half).to_f32()).collect())
            }
            (Self::Int8, true) => Data::Int8(bytes.iter().map(|byte| byte.cast_signed()).collect()),
            (Self::UInt8, true) => Data::UInt8(bytes.to_vec()),
            (Self::Int32, true) => Data::Int32(words.map(|&word| i32::from_le_bytes(word)).collect()),
            (Self::Bool, _) => Data::Bool(bytes.iter().map(|&byte| byte != 0).collect()),
            (Self::Int8, false) => ints(&mut bytes.iter().map(|byte| byte.cast_signed().into())),
            (Self::UInt8 | Self::Other(_), _) => ints(&mut bytes.iter().map(|&byte| byte.into())),
            (Self::Int32, false) => ints(&mut words.map(|&word| i32::from_le_bytes(word).into())),
            (Self::Int16, _) => {
                ints(&mut bytes.as_chunks().0.iter().map(|&half| i16::from_le_bytes(half).into()))
            }
            (Self::Int64, _) => ints(&mut bytes.as_chunks().0.iter().map(|&long| i64::from_le_bytes(long))),
        }
    }
}
