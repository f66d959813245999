//! The format: the length of a JSON header as u64, the header with names, types, shapes and offsets, then the
//! numbers; all little-endian.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};
use opendr_onnx::{FloatType, element_count};
use serde::Deserialize;

/// Maximum size of the header by the format, in bytes.
const MAX_HEADER: u64 = 100_000_000;

/// A parsed safetensors file with validated offsets; the numbers are not copied.
pub struct SafetensorsFile<'a> {
    metadata: BTreeMap<String, String>,
    /// `None` for integers.
    tensors: BTreeMap<String, (Entry, Option<FloatType>)>,
    data: &'a [u8],
}

#[derive(Deserialize)]
struct Header {
    #[serde(rename = "__metadata__", default)]
    metadata: BTreeMap<String, String>,
    #[serde(flatten)]
    tensors: BTreeMap<String, Entry>,
}

#[derive(Deserialize)]
struct Entry {
    dtype: String,
    shape: Vec<usize>,
    data_offsets: [usize; 2],
}

/// A tensor of floating-point numbers.
pub struct FloatTensor<'a> {
    /// Name, e.g. `features.0.weight`.
    pub name: &'a str,
    /// Size of each axis.
    pub dims: &'a [usize],
    /// Format of the numbers.
    pub float_type: FloatType,
    /// The numbers in row-major order, little-endian; their number matches `dims`.
    pub bytes: &'a [u8],
}

impl<'a> SafetensorsFile<'a> {
    /// Returns whether `head` is the start of a safetensors file.
    pub fn is_start(head: &[u8]) -> bool {
        let length = head.first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
        length.is_some_and(|length| length <= MAX_HEADER) && head.get(8) == Some(&b'{')
    }

    /// Reads the header of a file.
    ///
    /// # Errors
    /// `Format` for a damaged file, `Unsupported` for unknown number types.
    pub fn read(bytes: &'a [u8]) -> Result<Self> {
        let length = bytes.first_chunk().map(|bytes| u64::from_le_bytes(*bytes)).unwrap_or_default();
        let end = usize::try_from(length).ok().and_then(|length| length.checked_add(8));
        let (header, data) = end
            .and_then(|end| Some((bytes.get(8..end)?, bytes.get(end..)?)))
            .ok_or_else(|| Error::format("safetensors: the header is truncated; download the file again"))?;
        let Header { metadata, tensors } = serde_json::from_slice(header)
            .map_err(|error| Error::format("safetensors: the header is damaged").with_source(error))?;
        let typed = |(name, entry): (String, Entry)| {
            let float_type = entry.checked(&name, data.len())?;
            Ok((name, (entry, float_type)))
        };
        let tensors = tensors.into_iter().map(typed).collect::<Result<_>>()?;
        Ok(Self { metadata, tensors, data })
    }

    /// Returns an entry of the file's metadata, e.g. `format`.
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.metadata.get(key).map(String::as_str)
    }

    /// Returns the tensor of that name; `None` where there is none, or one of integers.
    pub fn float(&self, name: &str) -> Option<FloatTensor<'_>> {
        let (name, (entry, float_type)) = self.tensors.get_key_value(name)?;
        self.tensor(name, entry, (*float_type)?)
    }

    /// Returns all tensors of floating-point numbers, sorted by name.
    pub fn floats(&self) -> impl Iterator<Item = FloatTensor<'_>> {
        self.tensors.iter().filter_map(|(name, (entry, float_type))| self.tensor(name, entry, (*float_type)?))
    }

    fn tensor<'s>(
        &'s self,
        name: &'s str,
        entry: &'s Entry,
        float_type: FloatType,
    ) -> Option<FloatTensor<'s>> {
        let [start, end] = entry.data_offsets;
        Some(FloatTensor { name, dims: &entry.shape, float_type, bytes: self.data.get(start..end)? })
    }
}

impl Entry {
    /// Checks that the tensor lies within `size` bytes, and returns its type, `None` for integers.
    fn checked(&self, name: &str, size: usize) -> Result<Option<FloatType>> {
        let Self { dtype, shape, data_offsets: [start, end] } = self;
        let float_type = match dtype.as_str() {
            "F64" => FloatType::F64,
            "F32" => FloatType::F32,
            "F16" => FloatType::F16,
            "BF16" => FloatType::Bf16,
            "BOOL" | "U8" | "I8" | "I16" | "U16" | "I32" | "U32" | "I64" | "U64" => return Ok(None),
            other => {
                return Err(Error::unsupported(format!(
                    "safetensors: weight {name:.80?} has the unsupported type {other:.20?}; save it as F32"
                )));
            }
        };
        let wanted = element_count(shape).and_then(|count| count.checked_mul(float_type.bytes()));
        match end.checked_sub(*start) {
            given @ Some(_) if given == wanted && *end <= size => Ok(Some(float_type)),
            _ => Err(Error::format(format!(
                "safetensors: weight {name:.80?} of shape {shape:?} does not match bytes {start} to {end} of {size}"
            ))),
        }
    }
}
