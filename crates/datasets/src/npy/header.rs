//! The head of an `.npy` file: what numbers follow, and in which order.

use opendr_engine::{Error, Result};

/// Bytes within which a header must end; NumPy's own bound on the dictionary is 10,000.
pub(super) const MAX_BYTES: u64 = 16 << 10;
const MAX_AXES: usize = 32;
const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// What one number of the array is.
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
        let refused = || {
            Error::unsupported(format!(
                "an array of type {descr:.40?} is not read; save it as integers or floats of 16 to 64 bits"
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
            _ => return Err(refused()),
        };
        let bytes = if kind == Kind::Bool { 1 } else { usize::from(bytes - b'0') };
        Ok(Self { kind, bytes, big_endian: order == b'>' })
    }

    /// Bytes a number.
    pub fn bytes(self) -> usize {
        self.bytes
    }

    /// Whether the numbers are whole.
    pub fn is_integer(self) -> bool {
        self.kind != Kind::Float
    }

    /// The numbers in `data`; integers over 2^53 are rounded.
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
            (Kind::Float, 2) => f64::from(f32_from_f16(word as u16)),
            (Kind::Float, 4) => f64::from(f32::from_bits(word as u32)),
            (Kind::Float, _) => f64::from_bits(word),
            (Kind::Bool, _) => f64::from(u8::from(word != 0)),
            (Kind::Unsigned, _) => word as f64,
        }
    }
}

fn f32_from_f16(half: u16) -> f32 {
    let (sign, exponent, mantissa) = (u32::from(half >> 15) << 31, half >> 10 & 31, u32::from(half & 1023));
    match exponent {
        0 => f32::from_bits(sign | (mantissa as f32 / 16_777_216.0).to_bits()),
        31 => f32::from_bits(sign | 0x7f80_0000 | mantissa << 13),
        _ => f32::from_bits(sign | (u32::from(exponent) + 112) << 23 | mantissa << 13),
    }
}

/// What an `.npy` file holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NpyHeader {
    number: NpyType,
    shape: Vec<usize>,
    fortran_order: bool,
    data_offset: usize,
}

impl NpyHeader {
    /// Reads the header at the begin of `bytes`.
    ///
    /// # Errors
    /// `Format` when there is none, `Unsupported` for other arrays than of plain numbers.
    pub fn parse(bytes: &[u8]) -> Result<Self> {
        let wrong = || Error::format("does not begin as an .npy file; write it with numpy.save");
        let rest = bytes.strip_prefix(MAGIC).ok_or_else(wrong)?;
        let (length, start) = match rest {
            [1, _, a, b, ..] => (usize::from(u16::from_le_bytes([*a, *b])), 10),
            [2 | 3, _, a, b, c, d, ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, 12),
            [1..=3, ..] | [] => return Err(wrong()),
            [version, ..] => {
                return Err(Error::unsupported(format!(
                    "version {version} of .npy; save it with version 3 or less"
                )));
            }
        };
        let data_offset = start + length.min(u32::MAX as usize);
        let text = bytes.get(start..data_offset).filter(|_| data_offset as u64 <= MAX_BYTES).ok_or_else(|| {
            Error::format(format!(
                "a header of {length} bytes where {} are there and {MAX_BYTES} allowed; the file is damaged",
                bytes.len()
            ))
        })?;
        let mut literal = Literal { rest: text };
        let (descr, fortran_order, shape) = literal.dictionary().ok_or_else(|| {
            let shown = String::from_utf8_lossy(text);
            Error::format(format!(
                "the header {:.120?} is no dictionary of descr, fortran_order, shape",
                shown.trim()
            ))
        })?;
        let number = NpyType::from_descr(&descr)?;
        let header = Self { number, shape, fortran_order, data_offset };
        header.byte_count().map(|_| header.clone()).ok_or_else(|| {
            Error::format(format!("an array of shape {:?} is too large for any memory", header.shape))
        })
    }

    /// What one number is.
    pub fn number(&self) -> NpyType {
        self.number
    }

    /// Size of each axis.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Whether the first axis runs fastest.
    pub fn fortran_order(&self) -> bool {
        self.fortran_order
    }

    /// The byte at which the numbers begin.
    pub fn data_offset(&self) -> usize {
        self.data_offset
    }

    /// Bytes of all numbers; `None` when no memory could hold them.
    fn byte_count(&self) -> Option<u64> {
        let sides = self.shape.iter().try_fold(1usize, |count, side| count.checked_mul((*side).max(1)))?;
        let bytes = sides.checked_mul(self.number.bytes)?.checked_add(self.data_offset)?;
        let empty = self.shape.contains(&0);
        isize::try_from(bytes).ok().map(|_| if empty { 0 } else { (bytes - self.data_offset) as u64 })
    }

    /// Compares a file of `size` bytes with what its header promises.
    ///
    /// # Errors
    /// `Format` when numbers are missing.
    pub fn check_size(&self, size: u64) -> Result<()> {
        let there = size.saturating_sub(self.data_offset as u64);
        match self.byte_count() {
            Some(wanted) if wanted <= there => Ok(()),
            wanted => Err(Error::format(format!(
                "an array of shape {:?} has {there} bytes instead of {}; the file is cut off",
                self.shape,
                wanted.unwrap_or(u64::MAX)
            ))),
        }
    }
}

/// The Python dictionary of a header, of which only strings, booleans and tuples of numbers are known.
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

    /// The type, or the text of the list that describes a structure, to be shown.
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
