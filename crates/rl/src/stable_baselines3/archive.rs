//! Nested archives: `model.save` writes a zip that contains the zips of `torch.save`.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{Cursor, Read as _};

use opendr_engine::{Error, Result, ResultExt as _};
use zip::ZipArchive;

use super::pickle::tensors_from_pickle;

/// Maximum size of a member; the largest policies have a few megabytes.
const MAX_MEMBER_BYTES: u64 = 512 << 20;
/// Maximum number of numbers in all tensors.
const MAX_NUMBERS: usize = 128 << 20;

/// A tensor of a state dictionary.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tensor {
    pub shape: Vec<usize>,
    pub numbers: Vec<f32>,
}

/// A zip in memory.
pub(super) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
}

impl<'a> Archive<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self> {
        let zip = ZipArchive::new(Cursor::new(bytes));
        let zip = zip.map_err(|error| Error::format("the file is not a zip archive").with_source(error))?;
        Ok(Self { zip })
    }

    /// Returns the bytes of a member.
    pub fn member(&mut self, name: &str) -> Result<Vec<u8>> {
        let missing =
            |error| Error::format(format!("the archive has no readable member {name:?}")).with_source(error);
        let member = self.zip.by_name(name).map_err(missing)?;
        let size = member.size();
        if size > MAX_MEMBER_BYTES {
            return Err(Error::invalid_input(format!(
                "{name:?} has {size} bytes, more than the limit of {MAX_MEMBER_BYTES}"
            )));
        }
        let mut bytes = Vec::new();
        member.take(MAX_MEMBER_BYTES).read_to_end(&mut bytes).context(|| format!("unpacking {name:?}"))?;
        Ok(bytes)
    }

    /// Returns the tensors of a member written by `torch.save`, by name.
    pub fn tensors(&mut self, name: &str) -> Result<BTreeMap<String, Tensor>> {
        let bytes = self.member(name)?;
        let mut inner = Archive::open(&bytes).context(|| name.to_owned())?;
        let names = inner.zip.file_names().filter_map(Result::ok);
        let pickled = names.map(Cow::into_owned).find(|name: &String| name.ends_with("/data.pkl"));
        let Some(pickled) = pickled else {
            return Err(Error::format(format!(
                "{name:?} has no data.pkl; save it with PyTorch 1.6 or later"
            )));
        };
        let folder = pickled.trim_end_matches("data.pkl").to_owned();
        if inner.member(&format!("{folder}byteorder")).is_ok_and(|order| order != b"little") {
            return Err(Error::unsupported(
                "the tensors are big-endian; save the policy on a little-endian machine",
            ));
        }
        let mut storages = BTreeMap::<String, Vec<u8>>::new();
        let (mut tensors, mut total) = (BTreeMap::new(), 0usize);
        for (name, place) in tensors_from_pickle(&inner.member(&pickled)?)? {
            let count = place.shape.iter().try_fold(1usize, |count, size| count.checked_mul(*size));
            total = total.saturating_add(count.unwrap_or(usize::MAX));
            let Some(count) = count.filter(|_| total <= MAX_NUMBERS) else {
                return Err(Error::invalid_input(format!(
                    "with {name}, the tensors exceed {MAX_NUMBERS} numbers"
                )));
            };
            if !storages.contains_key(&place.storage) {
                let member = format!("{folder}data/{}", place.storage);
                storages.insert(place.storage.clone(), inner.member(&member)?);
            }
            let storage = storages.get(&place.storage).map_or(&[][..], |bytes| bytes.as_chunks::<4>().0);
            let end = place.offset.checked_add(count);
            let numbers = end
                .and_then(|end| storage.get(place.offset..end))
                .ok_or_else(|| Error::format(format!("{name} exceeds its storage; the file is damaged")))?;
            let numbers = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
            tensors.insert(name, Tensor { shape: place.shape, numbers });
        }
        Ok(tensors)
    }
}
