//! Files in the safetensors format: a length, JSON, numbers.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// Arrays of numbers by name, and text, in the safetensors format.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TensorFile {
    header: Header,
    data: Vec<u8>,
}

/// JSON header of the format: tensors by name, and metadata.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Header {
    #[serde(rename = "__metadata__")]
    metadata: BTreeMap<String, String>,
    #[serde(flatten)]
    tensors: BTreeMap<String, Tensor>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Tensor {
    dtype: String,
    shape: Vec<usize>,
    data_offsets: [usize; 2],
}

const MAX_HEADER_BYTES: usize = 16 << 20;

impl TensorFile {
    /// Sets a text of the metadata.
    pub fn set_metadata(&mut self, key: &str, text: String) {
        self.header.metadata.insert(key.to_owned(), text);
    }

    /// Returns a text of the metadata.
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.header.metadata.get(key).map(String::as_str)
    }

    /// Adds an array. Arrays of eight-byte numbers come first, so that all are aligned.
    pub fn add_f64(&mut self, name: &str, numbers: &[f64]) {
        self.add(name, "F64", numbers.len(), numbers.iter().flat_map(|x| x.to_le_bytes()));
    }

    /// Adds an array.
    pub fn add_f32(&mut self, name: &str, numbers: &[f32]) {
        self.add(name, "F32", numbers.len(), numbers.iter().flat_map(|x| x.to_le_bytes()));
    }

    fn add(&mut self, name: &str, dtype: &str, count: usize, bytes: impl Iterator<Item = u8>) {
        let start = self.data.len();
        self.data.extend(bytes);
        let data_offsets = [start, self.data.len()];
        let tensor = Tensor { dtype: dtype.to_owned(), shape: vec![count], data_offsets };
        self.header.tensors.insert(name.to_owned(), tensor);
    }

    /// Returns an array of eight-byte numbers.
    ///
    /// # Errors
    /// `Format` where there is none of this name.
    pub fn f64(&self, name: &str) -> Result<Vec<f64>> {
        let chunks = self.tensor(name, "F64")?.as_chunks::<8>().0.iter();
        Ok(chunks.map(|bytes| f64::from_le_bytes(*bytes)).collect())
    }

    /// Returns an array of finite four-byte numbers.
    ///
    /// # Errors
    /// `Format` where there is none of this name, or one of its numbers is not finite.
    pub fn f32(&self, name: &str) -> Result<Vec<f32>> {
        let chunks = self.tensor(name, "F32")?.as_chunks::<4>().0.iter();
        let numbers: Vec<_> = chunks.map(|bytes| f32::from_le_bytes(*bytes)).collect();
        match numbers.iter().position(|number| !number.is_finite()) {
            None => Ok(numbers),
            Some(at) => {
                Err(Error::format(format!("number {at} of {name} is {}; save the policy again", numbers[at])))
            }
        }
    }

    fn tensor(&self, name: &str, dtype: &str) -> Result<&[u8]> {
        let tensor = self.header.tensors.get(name).filter(|tensor| tensor.dtype == dtype);
        let range = tensor.map(|tensor| tensor.data_offsets[0]..tensor.data_offsets[1]);
        range.and_then(|range| self.data.get(range)).ok_or_else(damaged)
    }

    /// Returns the bytes of the file.
    ///
    /// # Errors
    /// `Internal` where the header cannot be written.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let mut json = serde_json::to_vec(&self.header)
            .map_err(|error| Error::internal("the header cannot be written as JSON").with_source(error))?;
        json.resize(json.len().next_multiple_of(8), b' ');
        Ok([&(json.len() as u64).to_le_bytes()[..], &json, &self.data].concat())
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// `Format` for a damaged or other file.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let (length, rest) = bytes.split_first_chunk::<8>().ok_or_else(damaged)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        let header = rest.get(..length).filter(|_| length <= MAX_HEADER_BYTES).ok_or_else(damaged)?;
        let header = serde_json::from_slice(header)
            .map_err(|error| Error::format("the header is not that of a policy").with_source(error))?;
        Ok(Self { header, data: rest[length..].to_vec() })
    }
}

fn damaged() -> Error {
    Error::format("the file is not a complete safetensors file; save the policy again")
}
