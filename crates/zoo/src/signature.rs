//! Signatures of the containers of a model repository (minisign: Ed25519).

use std::fmt;
use std::path::Path;

use minisign_verify::{PublicKey, Signature};
use opendr_engine::model::{MANIFEST_NAME, Manifest};
use opendr_engine::{Error, Result, ResultExt};

use crate::item::Item;

/// Name of the signature beside the manifest, which has size and checksum of every other file of the container.
pub(crate) const SIGNATURE_NAME: &str = "model.json.minisig";
/// Maximum size of a signature: two lines of comments and two of numbers.
pub(crate) const MAX_SIGNATURE_BYTES: u64 = 16 << 10;

/// The public key of a model repository. With it, only signed containers of the repository are used.
#[derive(Clone, PartialEq, Eq)]
pub struct RepositoryKey {
    text: String,
    key: PublicKey,
}

impl fmt::Debug for RepositoryKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("RepositoryKey").field(&self.text).finish()
    }
}

impl RepositoryKey {
    /// Reads a public key of minisign: its 56 characters of base64, or the path of its file.
    ///
    /// # Errors
    /// `InvalidParam` for what is neither.
    pub fn new(text: &str) -> Result<Self> {
        let text = text.trim();
        if let Ok(key) = PublicKey::from_base64(text) {
            return Ok(Self { text: text.to_owned(), key });
        }
        let content = std::fs::read_to_string(text).map_err(|error| {
            Error::invalid_param(format!(
                "the key of the model repository, {text:?}, is neither a public key of minisign nor a readable file: {error}"
            ))
        })?;
        let line = content.lines().find(|line| !line.contains("comment:") && !line.trim().is_empty());
        let own = line.unwrap_or_default().trim();
        let key = PublicKey::from_base64(own).map_err(|_| {
            Error::invalid_param(format!("{text} is no public key of minisign, which has the extension .pub"))
        })?;
        Ok(Self { text: own.to_owned(), key })
    }

    /// Returns the key in base64.
    pub fn base64(&self) -> &str {
        &self.text
    }

    /// Verifies the manifest of an item's container at `place`.
    ///
    /// # Errors
    /// `Integrity` without a signature by this key, or for the container of another item.
    pub(crate) fn verify(
        &self,
        item: &Item<'_>,
        manifest: &[u8],
        signature: Option<&[u8]>,
        place: &str,
    ) -> Result<()> {
        let Some(signature) = signature else {
            return Err(Error::integrity(format!(
                "{place} has no {SIGNATURE_NAME}, and OPENDR_MODEL_KEY is set; sign the repository (cargo xtask zoo publish)"
            )));
        };
        let signature = std::str::from_utf8(signature).ok().and_then(|text| Signature::decode(text).ok());
        let verified =
            signature.is_some_and(|signature| self.key.verify(manifest, &signature, false).is_ok());
        if !verified {
            return Err(Error::integrity(format!(
                "{place}: {SIGNATURE_NAME} is not by the key {}",
                self.text
            )));
        }
        let own = Manifest::from_json(manifest).context(|| place.to_owned())?;
        if (own.learner.as_str(), &own.variant) != (item.card.learner.as_str(), &item.variant.name) {
            return Err(Error::integrity(format!(
                "{place} is signed as {}/{}, not as {item}",
                own.learner, own.variant
            )));
        }
        Ok(())
    }

    /// Verifies an item's container in a folder, as [`verify`](Self::verify).
    pub(crate) fn verify_folder(&self, item: &Item<'_>, folder: &Path) -> Result<()> {
        let place = folder.display().to_string();
        let manifest = std::fs::read(folder.join(MANIFEST_NAME)).context(|| place.clone())?;
        let signature = std::fs::read(folder.join(SIGNATURE_NAME)).ok();
        self.verify(item, &manifest, signature.as_deref(), &place)
    }
}
