//! Arrays in NumPy's `.npy` files, read in parts: only the header is read when a file is opened.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

mod header;

pub use header::{NpyHeader, NpyType};

/// Largest part that is read at once, in bytes; values of one byte become eight times as large.
const MAX_PART_BYTES: u64 = 256 << 20;

/// An `.npy` file whose parts along the first axis are read on demand, from any thread.
#[derive(Debug, Clone)]
pub struct NpyFile {
    path: PathBuf,
    header: NpyHeader,
}

impl NpyFile {
    /// Reads the header of the file at `path`, and compares it with the file's size.
    ///
    /// # Errors
    /// `NotFound` or `Io` if it cannot be read; `Format` if it is not an `.npy` file or truncated; `Unsupported`
    /// for arrays of Python objects or structures. All have the path.
    pub fn open(path: impl Into<PathBuf>) -> Result<Self> {
        let path = path.into();
        let read = || -> Result<NpyHeader> {
            let file = File::open(&path)?;
            let size = file.metadata()?.len();
            let mut head = Vec::new();
            file.take(header::MAX_BYTES).read_to_end(&mut head)?;
            let header = NpyHeader::parse(&head)?;
            header.check_size(size)?;
            Ok(header)
        };
        let header = read().context(|| format!("opening {}", path.display()))?;
        Ok(Self { path, header })
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the header.
    pub fn header(&self) -> &NpyHeader {
        &self.header
    }

    /// Returns the size of each axis.
    pub fn shape(&self) -> &[usize] {
        self.header.shape()
    }

    /// Reads the values at `index` of the first axis; of the other axes, the last varies fastest.
    ///
    /// # Errors
    /// `NotFound` past the end, `Unsupported` for Fortran order with several axes (parts are not contiguous),
    /// `InvalidInput` for a part over 256 MB, `Io`.
    pub fn part(&self, index: usize) -> Result<Vec<f64>> {
        let shape = self.shape();
        let Some((count, rest)) = shape.split_first().filter(|(count, _)| index < **count) else {
            return Err(Error::not_found(format!(
                "no part {index} in {} of shape {shape:?}",
                self.path.display()
            )));
        };
        let side: usize = rest.iter().product();
        if self.header.fortran_order() && *count > 1 && side > 1 {
            return Err(Error::unsupported(format!(
                "{} is in Fortran order; save it with numpy.ascontiguousarray",
                self.path.display()
            )));
        }
        self.read(index * side, side)
    }

    /// Reads all values; the last axis varies fastest.
    ///
    /// # Errors
    /// `InvalidInput` for over 256 MB, `Io`.
    pub fn all(&self) -> Result<Vec<f64>> {
        let numbers = self.read(0, self.shape().iter().product())?;
        if self.header.fortran_order() {
            return Ok(c_from_fortran(&numbers, self.shape()));
        }
        Ok(numbers)
    }

    /// Reads `count` values from `first` on, in the order of the file. The header is checked, so nothing overflows.
    fn read(&self, first: usize, count: usize) -> Result<Vec<f64>> {
        let width = self.header.number().bytes();
        let (offset, bytes) = ((first * width) as u64, (count * width) as u64);
        let read = || {
            if bytes > MAX_PART_BYTES {
                return Err(Error::invalid_input(format!(
                    "a part has {bytes} bytes; save the array in parts of at most {MAX_PART_BYTES}"
                )));
            }
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(self.header.data_offset() as u64 + offset))?;
            let mut data = Vec::with_capacity(bytes as usize);
            file.take(bytes).read_to_end(&mut data)?;
            if data.len() as u64 != bytes {
                return Err(Error::format(format!(
                    "the part has {} of {bytes} bytes; the file is truncated",
                    data.len()
                )));
            }
            Ok(self.header.number().numbers(&data))
        };
        read().context(|| format!("reading {}", self.path.display()))
    }
}

/// Parses the bytes of an `.npy` file; returns the shape, and the values with the last axis varying fastest.
///
/// # Errors
/// As [`NpyFile::open`].
pub fn array_from_npy(bytes: &[u8]) -> Result<(Vec<usize>, Vec<f64>)> {
    let header = NpyHeader::parse(bytes)?;
    header.check_size(bytes.len() as u64)?;
    let count: usize = header.shape().iter().product();
    let data = bytes.get(header.data_offset()..).unwrap_or_default();
    let data = data.get(..count * header.number().bytes()).unwrap_or_default();
    let numbers = header.number().numbers(data);
    let numbers = if header.fortran_order() { c_from_fortran(&numbers, header.shape()) } else { numbers };
    Ok((header.shape().to_vec(), numbers))
}

/// Type of the values of a written array.
pub trait NpyElement: Copy {
    /// NumPy's name of the type, little-endian.
    const DESCR: &'static str;

    /// Appends the bytes of a value.
    fn write(self, bytes: &mut Vec<u8>);
}

macro_rules! elements {
    ($($kind:ty => $descr:literal),* $(,)?) => {$(
        impl NpyElement for $kind {
            const DESCR: &'static str = $descr;

            fn write(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    )*};
}

elements! { f32 => "<f4", i32 => "<i4", i64 => "<i8", u8 => "|u1", i8 => "|i1" }

impl NpyElement for bool {
    const DESCR: &'static str = "|b1";

    fn write(self, bytes: &mut Vec<u8>) {
        bytes.push(u8::from(self));
    }
}

/// Returns the bytes of an `.npy` file (version 1.0) of values; the last axis varies fastest.
///
/// # Errors
/// `InvalidInput` if `shape` does not match the number of values.
pub fn npy_from_values<T: NpyElement>(values: &[T], shape: &[usize]) -> Result<Vec<u8>> {
    let mut bytes = header_bytes(T::DESCR, values.len(), shape)?;
    bytes.reserve(size_of_val(values));
    values.iter().for_each(|value| value.write(&mut bytes));
    Ok(bytes)
}

/// Returns magic, version and dictionary, padded with blanks to a multiple of 64 bytes.
fn header_bytes(number: &str, count: usize, shape: &[usize]) -> Result<Vec<u8>> {
    if shape.iter().try_fold(1usize, |product, side| product.checked_mul(*side)) != Some(count) {
        return Err(Error::invalid_input(format!("an array of shape {shape:?} cannot have {count} values")));
    }
    let sides: String = shape.iter().map(|side| format!("{side}, ")).collect();
    let sides = if shape.len() == 1 { sides.trim_end() } else { sides.trim_end_matches(", ") };
    let text = format!("{{'descr': '{number}', 'fortran_order': False, 'shape': ({sides}), }}");
    let padded = (10 + text.len() + 1).next_multiple_of(64) - 10;
    let length = u16::try_from(padded)
        .map_err(|_| Error::invalid_input(format!("{} axes do not fit into the header", shape.len())))?;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(length.to_le_bytes());
    bytes.extend(format!("{text:<width$}\n", width = padded - 1).into_bytes());
    Ok(bytes)
}

/// Converts the values of an array from Fortran order to C order.
pub(crate) fn c_from_fortran(numbers: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut at = vec![0usize; shape.len()];
    let mut ordered = Vec::with_capacity(numbers.len());
    for _ in 0..numbers.len() {
        let place = at.iter().zip(shape).rev().fold(0, |place, (index, side)| place * side + index);
        ordered.extend(numbers.get(place));
        for (index, side) in at.iter_mut().zip(shape).rev() {
            *index += 1;
            if *index < *side {
                break;
            }
            *index = 0;
        }
    }
    ordered
}

#[cfg(test)]
mod tests;
