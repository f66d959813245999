//! Reading of weights in any format.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};
use opendr_import::SafetensorsFile;

use crate::weights::table::MAX_BYTES;
use crate::weights::{WeightTable, onnx, pytorch, safetensors};

impl WeightTable {
    /// Reads a file of weights, whose format is detected from its content: safetensors, PyTorch's `.pth` or `.pt` (nothing in
    /// it is executed), ONNX (quantised integers become floats).
    ///
    /// # Errors
    /// `NotFound` or `Io` when the file cannot be read; `Format` for another format or a damaged file; `Unsupported` for a file
    /// that is too large or too old. All errors contain the path.
    pub fn from_file(path: &Path) -> Result<Self> {
        read(path).context(|| format!("reading weights from {}", path.display()))
    }

    /// Reads as [`WeightTable::from_file`], from the content of a safetensors or ONNX file.
    ///
    /// # Errors
    /// As [`WeightTable::from_file`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        match Kind::of(bytes) {
            Kind::Safetensors => safetensors::table_from_safetensors(bytes),
            Kind::Onnx => onnx::table_from_onnx(bytes),
            Kind::Tar => Err(too_old()),
            Kind::Pytorch => {
                Err(Error::unsupported("PyTorch checkpoints can only be read from files, not from memory"))
            }
        }
    }
}

/// Format of a file of weights.
enum Kind {
    Safetensors,
    Pytorch,
    Tar,
    Onnx,
}

impl Kind {
    fn of(head: &[u8]) -> Self {
        if SafetensorsFile::is_start(head) {
            return Self::Safetensors;
        }
        match head {
            [b'P', b'K', 3, 4, ..] | [0x80, 0..=5, ..] => Self::Pytorch,
            _ if head.get(257..262) == Some(b"ustar") => Self::Tar,
            _ => Self::Onnx,
        }
    }
}

fn read(path: &Path) -> Result<WeightTable> {
    let mut file = File::open(path)?;
    let size = file.metadata()?.len();
    if size > MAX_BYTES {
        return Err(Error::unsupported(format!(
            "the file has {} MB; at most {} MB are supported",
            size >> 20,
            MAX_BYTES >> 20
        )));
    }
    let mut bytes = Vec::new();
    file.by_ref().take(512).read_to_end(&mut bytes)?;
    if matches!(Kind::of(&bytes), Kind::Pytorch) {
        return pytorch::table_from_pytorch(path);
    }
    file.take(MAX_BYTES).read_to_end(&mut bytes)?;
    WeightTable::from_bytes(&bytes)
}

fn too_old() -> Error {
    Error::unsupported("the checkpoint is of PyTorch before 0.1.10; save it again with a current PyTorch")
}
