//! Attachment of every message: sender, time and sequence number.

use opendr_engine::{Error, Result};

/// Attachment in the format of `rmw_zenoh_cpp`: sequence number and time in nanoseconds (8 bytes each, little-endian), then length
/// and bytes of the sender's id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Attachment {
    pub sequence_number: i64,
    pub source_timestamp: i64,
    pub source_gid: [u8; 16],
}

const BYTES: usize = 33;
const GID_BYTES: u8 = 16;

impl Attachment {
    pub fn to_bytes(self) -> [u8; BYTES] {
        let mut bytes = [0; BYTES];
        bytes[..8].copy_from_slice(&self.sequence_number.to_le_bytes());
        bytes[8..16].copy_from_slice(&self.source_timestamp.to_le_bytes());
        bytes[16] = GID_BYTES;
        bytes[17..].copy_from_slice(&self.source_gid);
        bytes
    }

    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        match bytes.first_chunk::<BYTES>() {
            Some(all) if bytes.len() == BYTES && all[16] == GID_BYTES => {
                let number = |at: usize| {
                    let mut number = [0; 8];
                    number.copy_from_slice(&all[at..at + 8]);
                    i64::from_le_bytes(number)
                };
                let mut source_gid = [0; 16];
                source_gid.copy_from_slice(&all[17..]);
                Ok(Self { sequence_number: number(0), source_timestamp: number(8), source_gid })
            }
            _ => Err(Error::format(format!(
                "an attachment of {} bytes is not in the format of ROS 2",
                bytes.len()
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_the_cpp_implementation() {
        let attachment = Attachment { sequence_number: 7, source_timestamp: 0x102, source_gid: [0xab; 16] };
        let bytes = attachment.to_bytes();
        assert_eq!(bytes[..17], [7, 0, 0, 0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, 16]);
        assert_eq!(bytes[17..], [0xab; 16]);
        assert_eq!(Attachment::from_bytes(&bytes).unwrap(), attachment);
    }

    #[test]
    fn other_bytes_are_refused() {
        let bytes = Attachment { sequence_number: 7, source_timestamp: 1, source_gid: [1; 16] }.to_bytes();
        for wrong in [&bytes[..32], &[&bytes[..], &[0]].concat(), &[], &[0; 33]] {
            assert!(Attachment::from_bytes(wrong).is_err(), "{wrong:?}");
        }
    }
}
