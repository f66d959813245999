//! SHA-256 checksums.

use std::fmt;
use std::io::{self, Read};
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use sha2::Digest;

use crate::{Error, Result};

/// A SHA-256 checksum; its text is 64 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Sha256([u8; 32]);

impl Sha256 {
    /// Computes the checksum of `bytes`.
    pub fn of(bytes: &[u8]) -> Self {
        Self(sha2::Sha256::digest(bytes).into())
    }

    /// Computes the checksum of the remaining bytes of `reader`, and returns it with their number.
    ///
    /// # Errors
    /// Returns errors of the reader.
    pub fn of_reader(mut reader: impl Read) -> io::Result<(Self, u64)> {
        let mut hasher = Sha256Hasher::default();
        let mut buffer = vec![0; 1 << 16];
        loop {
            match reader.read(&mut buffer)? {
                0 => return Ok((hasher.finish(), hasher.len())),
                count => hasher.update(&buffer[..count]),
            }
        }
    }

    /// Checks that `bytes` have this checksum.
    ///
    /// # Errors
    /// Returns `Integrity` if they have another one; `what` names them in the message.
    pub fn check(&self, what: &str, bytes: &[u8]) -> Result<()> {
        self.check_equal(what, &Self::of(bytes))
    }

    /// Checks that `found` is this checksum.
    ///
    /// # Errors
    /// Returns `Integrity` if it is another one; `what` names the bytes in the message.
    pub fn check_equal(&self, what: &str, found: &Self) -> Result<()> {
        if self == found {
            return Ok(());
        }
        Err(Error::integrity(format!(
            "{what} has the sha256 {found} instead of {self}: it is damaged or another version; download it again"
        )))
    }
}

/// Computes a [`Sha256`] incrementally.
#[derive(Clone, Default)]
pub struct Sha256Hasher {
    state: sha2::Sha256,
    len: u64,
}

impl Sha256Hasher {
    /// Adds the next piece.
    pub fn update(&mut self, bytes: &[u8]) {
        self.state.update(bytes);
        self.len += bytes.len() as u64;
    }

    /// Returns the number of bytes so far.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Returns whether there were no bytes so far.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns the checksum of the bytes so far.
    pub fn finish(&self) -> Sha256 {
        Sha256(self.state.clone().finalize().into())
    }
}

impl fmt::Debug for Sha256Hasher {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sha256Hasher").field("len", &self.len).finish_non_exhaustive()
    }
}

impl fmt::Display for Sha256 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Sha256 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Sha256 {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let bad = || Error::format(format!("{text:?} is not a sha256; give 64 hexadecimal digits"));
        if text.len() != 64 || !text.is_ascii() {
            return Err(bad());
        }
        let mut bytes = [0; 32];
        for (byte, pair) in bytes.iter_mut().zip(text.as_bytes().chunks_exact(2)) {
            let digit = |character: u8| char::from(character).to_digit(16).ok_or_else(bad);
            *byte = (digit(pair[0])? << 4 | digit(pair[1])?) as u8;
        }
        Ok(Self(bytes))
    }
}

impl TryFrom<String> for Sha256 {
    type Error = Error;

    fn try_from(text: String) -> Result<Self> {
        text.parse()
    }
}

impl From<Sha256> for String {
    fn from(digest: Sha256) -> Self {
        digest.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ErrorKind;

    const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    #[test]
    fn known_checksum_in_one_piece_and_in_three() {
        assert_eq!(Sha256::of(b"abc").to_string(), ABC);
        let mut hasher = Sha256Hasher::default();
        b"abc".chunks(1).for_each(|piece| hasher.update(piece));
        assert_eq!((hasher.finish().to_string().as_str(), hasher.len()), (ABC, 3));
        assert_eq!(Sha256::of_reader(&b"abc"[..]).unwrap(), (ABC.parse().unwrap(), 3));
    }

    #[test]
    fn invalid_text_is_rejected() {
        for text in ["", "00", &ABC[1..], &ABC.replace('b', "g"), &format!("é{}", &ABC[2..])] {
            assert_eq!(text.parse::<Sha256>().unwrap_err().kind(), ErrorKind::Format, "{text}");
        }
        assert_eq!(ABC.to_uppercase().parse::<Sha256>().unwrap(), Sha256::of(b"abc"));
    }
}
