//! Header of an `.npy` file: element type, shape and order.

use half::f16;
use opendr_engine::{Error, Result};

/// Largest size of a header in bytes; NumPy's own limit for the dictionary is 10,000.
pub(super) const MAX_BYTES: u64 = 16 << 10;
const MAX_AXES: usize = 32;
const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// Element type of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NpyType {
    kind: Kind,
    bytes: usize,
    big_endian: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Bool,
    Signed,
    Unsigned,
    Float,
}

impl NpyType {
    pub(crate) fn from_descr(descr: &str) -> Result<Self> {
        let unsupported = || {
            Error::unsupported(format!(
                "arrays of type {descr:.40?} are not supported; save integers or floats of 16 to 64 bits"
            ))
        };
        let (order, rest) = match descr.as_bytes() {
            [order @ (b'<' | b'>' | b'|' | b'='), rest @ ..] => (*order, rest),
            rest => (b'|', rest),
        };
        let (kind, bytes) = match rest {
            b"b1" | b"?" => (Kind::Bool, 1),
            [b'i', size @ (b'1' | b'2' | b'4' | b'8')] => (Kind::Signed, *size),
            [b'u', size @ (b'1' | b'2' | b'4' | b'8')] => (Kind::Unsigned, *size),
            [b'f', size @ (b'2' | b'4' | b'8')] => (Kind::Float, *size),
            _ => return Err(unsupported()),
        };
        let bytes = if kind == Kind::Bool { 1 } else { usize::from(bytes - b'0') };
        Ok(Self { kind, bytes, big_endian: order == b'>' })
    }

    /// Returns the bytes per value.
    pub fn bytes(self) -> usize {
        self.bytes
    }

    /// Returns whether the values are integers.
    pub fn is_integer(self) -> bool {
        self.kind != Kind::Float
    }

    /// Decodes the values of `data`; integers over 2^53 are rounded.
    pub(crate) fn numbers(self, data: &[u8]) -> Vec<f64> {
        data.chunks_exact(self.bytes).map(|bytes| self.number(bytes)).collect()
    }

    fn number(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 8];
        if self.big_endian {
            word.iter_mut().zip(bytes.iter().rev()).for_each(|(to, from)| *to = *from);
        } else {
            word.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        }
        let word = u64::from_le_bytes(word);
        let unused = 64 - 8 * self.bytes as u32;
        match (self.kind, self.bytes) {
            (Kind::Signed, _) => (((word << unused) as i64) >> unused) as f64,
            (Kind::Float, 2) => f16::from_bits(word as u16).to_f64(),
            (Kind::Float, 4) => f64::from(f32::from_bits(word as u32)),
            (Kind::Float, _) => f64::from_bits(word),
            (Kind::Bool, _) => f64::from(u8::from(word != 0)),
            (Kind::Unsigned, _) => word as f64,
        }
    }
}

/// Header of an `.npy` file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NpyHeader {
    number: NpyType,
    shape: Vec<usize>,
    fortran_order: bool,
    data_offset: usize,
}

impl NpyHeader {
    /// Parses the header at the start of `bytes`.
    ///
    /// # Errors
    /// `Format` without a header, `Unsupported` for arrays of other types than numbers.
    pub fn parse(bytes: &[u8]) -> Result<Self> {
        let wrong = || Error::format("does not start like an .npy file; write it with numpy.save");
        let rest = bytes.strip_prefix(MAGIC).ok_or_else(wrong)?;
        let (length, start) = match rest {
            [1, _, a, b, ..] => (usize::from(u16::from_le_bytes([*a, *b])), 10),
            [2 | 3, _, a, b, c, d, ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, 12),
            [1..=3, ..] | [] => return Err(wrong()),
            [version, ..] => {
                return Err(Error::unsupported(format!(
                    "version {version} of .npy is not supported; save it with version 3 or less"
                )));
            }
        };
        let data_offset = start + length.min(u32::MAX as usize);
        let text = bytes.get(start..data_offset).filter(|_| data_offset as u64 <= MAX_BYTES).ok_or_else(|| {
            Error::format(format!(
                "the header states {length} bytes, but the file has {} and the limit is {MAX_BYTES}; the file is damaged",
                bytes.len()
            ))
        })?;
        let mut literal = Literal { rest: text };
        let (descr, fortran_order, shape) = literal.dictionary().ok_or_else(|| {
            let text = String::from_utf8_lossy(text);
            Error::format(format!(
                "the header {:.120?} is not a dictionary of descr, fortran_order, shape",
                text.trim()
            ))
        })?;
        let number = NpyType::from_descr(&descr)?;
        let header = Self { number, shape, fortran_order, data_offset };
        header.byte_count().map(|_| header.clone()).ok_or_else(|| {
            Error::format(format!("an array of shape {:?} is too large for memory", header.shape))
        })
    }

    /// Returns the element type.
    pub fn number(&self) -> NpyType {
        self.number
    }

    /// Returns the size of each axis.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Returns whether the first axis varies fastest.
    pub fn fortran_order(&self) -> bool {
        self.fortran_order
    }

    /// Returns the byte offset of the values.
    pub fn data_offset(&self) -> usize {
        self.data_offset
    }

    /// Returns the bytes of all values; `None` if they exceed the address space.
    fn byte_count(&self) -> Option<u64> {
        let sides = self.shape.iter().try_fold(1usize, |count, side| count.checked_mul((*side).max(1)))?;
        let bytes = sides.checked_mul(self.number.bytes)?.checked_add(self.data_offset)?;
        let empty = self.shape.contains(&0);
        isize::try_from(bytes).ok().map(|_| if empty { 0 } else { (bytes - self.data_offset) as u64 })
    }

    /// Compares the header with a file of `size` bytes.
    ///
    /// # Errors
    /// `Format` if the file is too short.
    pub fn check_size(&self, size: u64) -> Result<()> {
        let available = size.saturating_sub(self.data_offset as u64);
        match self.byte_count() {
            Some(needed) if needed <= available => Ok(()),
            needed => Err(Error::format(format!(
                "an array of shape {:?} has {available} bytes instead of {}; the file is truncated",
                self.shape,
                needed.unwrap_or(u64::MAX)
            ))),
        }
    }
}

/// Parser of the Python dictionary of a header, with strings, booleans and tuples of numbers.
struct Literal<'a> {
    rest: &'a [u8],
}

impl Literal<'_> {
    fn dictionary(&mut self) -> Option<(String, bool, Vec<usize>)> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.expect(b'{')?;
        while !self.accept(b'}') {
            let key = self.string()?;
            self.expect(b':')?;
            match key.as_str() {
                "descr" => descr = Some(self.descr()?),
                "fortran_order" => fortran_order = Some(self.boolean()?),
                "shape" => shape = Some(self.tuple()?),
                _ => return None,
            }
            if !self.accept(b',') {
                self.expect(b'}')?;
                break;
            }
        }
        self.blanks();
        self.rest.is_empty().then_some(())?;
        Some((descr?, fortran_order?, shape?))
    }

    /// Parses the type, or the text of a list that describes a structure, for error messages.
    fn descr(&mut self) -> Option<String> {
        self.blanks();
        if self.rest.first() != Some(&b'[') {
            return self.string();
        }
        let end = self.rest.iter().position(|byte| *byte == b']')?;
        let (list, rest) = self.rest.split_at(end + 1);
        self.rest = rest;
        Some(String::from_utf8_lossy(list).into_owned())
    }

    fn string(&mut self) -> Option<String> {
        self.blanks();
        let (quote, rest) = self.rest.split_first().filter(|(quote, _)| matches!(quote, b'\'' | b'"'))?;
        let end = rest.iter().position(|byte| byte == quote)?;
        let (text, after) = rest.split_at(end);
        self.rest = after.get(1..)?;
        String::from_utf8(text.to_vec()).ok()
    }

    fn boolean(&mut self) -> Option<bool> {
        self.blanks();
        let (value, rest) = match (self.rest.strip_prefix(b"True"), self.rest.strip_prefix(b"False")) {
            (Some(rest), _) => (true, rest),
            (_, Some(rest)) => (false, rest),
            _ => return None,
        };
        self.rest = rest;
        Some(value)
    }

    fn tuple(&mut self) -> Option<Vec<usize>> {
        let mut sides = Vec::new();
        self.expect(b'(')?;
        while !self.accept(b')') {
            self.blanks();
            let digits = self.rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
            let (number, rest) = self.rest.split_at(digits);
            sides.push(std::str::from_utf8(number).ok()?.parse().ok()?);
            // Python 2 wrote long numbers with an L.
            self.rest = rest.strip_prefix(b"L").unwrap_or(rest);
            if sides.len() > MAX_AXES {
                return None;
            }
            if !self.accept(b',') {
                self.expect(b')')?;
                break;
            }
        }
        Some(sides)
    }

    fn blanks(&mut self) {
        self.rest = self.rest.trim_ascii_start();
    }

    fn accept(&mut self, byte: u8) -> bool {
        self.blanks();
        match self.rest.split_first() {
            Some((first, rest)) if *first == byte => {
                self.rest = rest;
                true
            }
            _ => false,
        }
    }

    fn expect(&mut self, byte: u8) -> Option<()> {
        self.accept(byte).then_some(())
    }
}
