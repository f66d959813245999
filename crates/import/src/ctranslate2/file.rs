//! The binary format of `model.bin`, versions 4 to 6 (CTranslate2 3.17 to 4.8 write version 6); all numbers are
//! little-endian.
//!
//! | what | as |
//! |---|---|
//! | version | u32 |
//! | name of the network's specification, its revision | text, u32 |
//! | number of variables | u32 |
//! | each: name, number of axes, their sizes, element type, bytes, elements | text, u8, u32 each, u8, u32, bytes |
//! | number of aliases | u32 |
//! | each: another name, name of the variable | text, text |
//!
//! A text is its length with the closing zero as u16, the bytes, the zero. Element types: 0 float32, 1 int8, 2 int16,
//! 3 int32, 4 float16, 5 bfloat16.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use opendr_onnx::{Array, Data, FloatType, element_count};

/// Maximum number of axes of a variable.
const MAX_AXES: u8 = 8;

/// A parsed file with validated sizes; elements are decoded on request.
pub struct Ctranslate2File<'a> {
    /// Name of the network's specification, e.g. `WhisperSpec`.
    pub specification: &'a str,
    variables: HashMap<&'a str, Variable<'a>>,
}

#[derive(Debug, Clone)]
struct Variable<'a> {
    dims: Vec<usize>,
    element: u8,
    bytes: &'a [u8],
}

impl<'a> Ctranslate2File<'a> {
    /// Reads the table of a file.
    ///
    /// # Errors
    /// `Format` for a damaged file, `Unsupported` for an unknown version or element type.
    pub fn read(bytes: &'a [u8]) -> Result<Self> {
        let mut rest = Rest(bytes);
        let version = rest.u32()?;
        if !(4..=6).contains(&version) {
            return Err(Error::unsupported(format!(
                "unsupported version {version} of CTranslate2's format, or another format; convert the model with CTranslate2 4"
            )));
        }
        let specification = rest.text()?;
        rest.u32()?;
        let mut variables = HashMap::new();
        for _ in 0..rest.u32()? {
            let (name, variable) = rest.variable()?;
            if variables.insert(name, variable).is_some() {
                return Err(Error::format(format!("CTranslate2: two variables have the name {name:.80?}")));
            }
        }
        for _ in 0..rest.u32()? {
            let (alias, name) = (rest.text()?, rest.text()?);
            let variable = variables.get(name).cloned().ok_or_else(|| missing(name))?;
            variables.insert(alias, variable);
        }
        match rest.0 {
            [] => Ok(Self { specification, variables }),
            more => Err(Error::format(format!("CTranslate2: {} unexpected bytes at the end", more.len()))),
        }
    }

    /// Returns whether there is a variable of that name.
    pub fn has(&self, name: &str) -> bool {
        self.variables.contains_key(name)
    }

    /// Returns whether all float variables have at most 16 bits.
    pub fn is_half(&self) -> bool {
        self.variables.values().all(|variable| variable.element != 0)
    }

    /// Returns the value of an integer variable; `None` when there is none.
    pub fn integer(&self, name: &str) -> Option<i64> {
        let Variable { element, bytes, .. } = self.variables.get(name)?;
        match (element, *bytes) {
            (1, &[byte]) => Some(i64::from(byte.cast_signed())),
            (2, &[a, b]) => Some(i64::from(i16::from_le_bytes([a, b]))),
            (3, &[a, b, c, d]) => Some(i64::from(i32::from_le_bytes([a, b, c, d]))),
            _ => None,
        }
    }

    /// Returns the numbers of a variable.
    ///
    /// # Errors
    /// `Format` when there is no such variable, `Unsupported` when it is quantised.
    pub fn floats(&self, name: &str) -> Result<Array> {
        let Variable { dims, element, bytes } = self.variables.get(name).ok_or_else(|| missing(name))?;
        let float_type = match element {
            0 => FloatType::F32,
            4 => FloatType::F16,
            5 => FloatType::Bf16,
            _ => {
                return Err(Error::unsupported(format!(
                    "CTranslate2: {name:?} is quantised; convert the model with --quantization float16"
                )));
            }
        };
        let floats = float_type.decode(bytes);
        if floats.iter().any(|value| !value.is_finite()) {
            return Err(Error::format(format!(
                "CTranslate2: {name:?} contains NaN or infinity; download the file again"
            )));
        }
        let array = Array::new(dims.clone(), Data::Float(floats));
        array.ok_or_else(|| Error::internal(format!("the decoded size of {name:?} does not match {dims:?}")))
    }
}

fn missing(name: &str) -> Error {
    Error::format(format!("CTranslate2: there is no variable {name:.80?}; download the file again"))
}

/// The unread bytes.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(|| {
            Error::format(format!(
                "CTranslate2: {count} bytes are needed, but {} are left; download the file again",
                self.0.len()
            ))
        })?;
        self.0 = rest;
        Ok(taken)
    }

    fn number<const N: usize>(&mut self) -> Result<[u8; N]> {
        let bytes = self.take(N)?;
        bytes.try_into().map_err(|_| Error::internal("a number has the wrong width"))
    }

    fn u32(&mut self) -> Result<u32> {
        self.number().map(u32::from_le_bytes)
    }

    fn u8(&mut self) -> Result<u8> {
        self.number().map(u8::from_le_bytes)
    }

    fn text(&mut self) -> Result<&'a str> {
        let length = u16::from_le_bytes(self.number()?);
        let bytes = self.take(length.into())?;
        let text = bytes.strip_suffix(b"\0").and_then(|bytes| std::str::from_utf8(bytes).ok());
        text.ok_or_else(|| Error::format("CTranslate2: a name is not valid text; download the file again"))
    }

    fn variable(&mut self) -> Result<(&'a str, Variable<'a>)> {
        let name = self.text()?;
        let axes = self.u8()?;
        if axes > MAX_AXES {
            return Err(Error::format(format!(
                "CTranslate2: {name:.80?} has {axes} axes, more than the supported {MAX_AXES}"
            )));
        }
        let dims = (0..axes).map(|_| Ok(self.u32()? as usize)).collect::<Result<Vec<_>>>()?;
        let element = self.u8()?;
        let width = match element {
            0 | 3 => 4,
            2 | 4 | 5 => 2,
            1 => 1,
            other => {
                return Err(Error::unsupported(format!(
                    "CTranslate2: {name:.80?} has the unknown type {other}"
                )));
            }
        };
        let size = self.u32()? as usize;
        if element_count(&dims).and_then(|count| count.checked_mul(width)) != Some(size) {
            return Err(Error::format(format!(
                "CTranslate2: {name:.80?} of shape {dims:?} does not have {size} bytes; download the file again"
            )));
        }
        Ok((name, Variable { dims, element, bytes: self.take(size)? }))
    }
}
