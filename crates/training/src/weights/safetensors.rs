//! Hugging Face's safetensors: a JSON header of names, types, shapes and places, then the numbers.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};
use serde::Deserialize;

use crate::weights::WeightTable;
use crate::weights::element::Element;
use crate::weights::pytorch::natural_order;

/// The largest header that the format allows, bytes.
const MAX_HEADER: u64 = 100_000_000;

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

/// Whether a file that starts so is a safetensors file.
pub(super) fn is_safetensors(head: &[u8]) -> bool {
    let length = head.first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
    length.is_some_and(|length| length <= MAX_HEADER) && head.get(8) == Some(&b'{')
}

/// The floating-point tensors of a file. Burn's own files have dense layers the other way round, which is undone.
pub(super) fn table_from_safetensors(bytes: &[u8]) -> Result<WeightTable> {
    let length = bytes.first_chunk().map(|bytes| u64::from_le_bytes(*bytes)).unwrap_or_default();
    let end = usize::try_from(length).ok().and_then(|length| length.checked_add(8));
    let (header, data) = end
        .and_then(|end| Some((bytes.get(8..end)?, bytes.get(end..)?)))
        .ok_or_else(|| Error::format("safetensors: the header is cut off; get the file anew"))?;
    let Header { metadata, tensors } = serde_json::from_slice(header)
        .map_err(|error| Error::format("safetensors: the header is damaged").with_source(error))?;
    if metadata.get("producer").is_some_and(|producer| producer == "burn") {
        return Err(Error::unsupported(
            "weights that Burn saved; load them with burn-store, which knows their layout",
        ));
    }
    let mut entries: Vec<_> = tensors.into_iter().collect();
    entries.sort_by(|(a, _), (b, _)| natural_order(a, b));
    let mut table = WeightTable::default();
    for (name, Entry { dtype, shape, data_offsets: [start, end] }) in entries {
        let element = match dtype.as_str() {
            "F64" => Element::F64,
            "F32" => Element::F32,
            "F16" => Element::F16,
            "BF16" => Element::Bf16,
            "BOOL" | "U8" | "I8" | "I16" | "U16" | "I32" | "U32" | "I64" | "U64" => continue,
            other => {
                return Err(Error::unsupported(format!(
                    "safetensors: weight {name:.80?} is of type {other:.20?}; save it as F32"
                )));
            }
        };
        let place = data.get(start..end).filter(|place| {
            let count = opendr_onnx::element_count(&shape);
            count.and_then(|count| count.checked_mul(element.bytes())) == Some(place.len())
        });
        let place = place.ok_or_else(|| {
            Error::format(format!(
                "safetensors: weight {name:.80?} of shape {shape:?} does not lie in bytes {start} to {end} of {}",
                data.len()
            ))
        })?;
        table.add_elements(name, shape, element, place)?;
    }
    Ok(table)
}
