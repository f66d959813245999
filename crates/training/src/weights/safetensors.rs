//! Hugging Face's safetensors.

use opendr_engine::{Error, Result};
use opendr_import::SafetensorsFile;

use crate::weights::WeightTable;
use crate::weights::pytorch::natural_order;

/// Returns the floating-point tensors of a file; integers in checkpoints are counters and not weights.
pub(super) fn table_from_safetensors(bytes: &[u8]) -> Result<WeightTable> {
    let file = SafetensorsFile::read(bytes)?;
    if file.metadata("producer") == Some("burn") {
        return Err(Error::unsupported(
            "the weights were saved by Burn; load them with burn-store, which supports their layout",
        ));
    }
    let mut tensors: Vec<_> = file.floats().collect();
    tensors.sort_by(|a, b| natural_order(a.name, b.name));
    let mut table = WeightTable::default();
    for tensor in tensors {
        table.add_elements(tensor.name.to_owned(), tensor.dims.to_vec(), tensor.float_type, tensor.bytes)?;
    }
    Ok(table)
}
