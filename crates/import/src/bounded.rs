//! Reading of files with a size limit.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};

/// Maximum size of weights; after widening, more do not fit into one ONNX file.
pub const MAX_BYTES: u64 = 1 << 29;

/// Reads a whole file.
///
/// # Errors
/// `Format` when it exceeds [`MAX_BYTES`]; `NotFound` or `Io` when it cannot be read.
pub fn read_bounded(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let file = File::open(path).context(|| format!("opening {}", path.display()))?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).context(|| format!("reading {}", path.display()))?;
    match bytes.len() as u64 > MAX_BYTES {
        true => Err(Error::format(format!("{} exceeds the limit of {MAX_BYTES} bytes", path.display()))),
        false => Ok(bytes),
    }
}
