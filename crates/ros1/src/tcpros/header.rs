//! Connection headers.

use std::io::{Read, Write};
use std::net::TcpStream;

use opendr_engine::{Error, Result};

use super::frame::read_body;
use crate::connection::Timed;

/// Maximum size of a header in bytes; one with the longest message definition has some ten kilobytes.
const MOST_HEADER: u32 = 1 << 20;

/// Fields of name and value.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Header(Vec<(String, String)>);

impl Header {
    pub fn new<const N: usize>(fields: [(&str, &str); N]) -> Self {
        Self(fields.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect())
    }

    /// Creates the header that a peer receives before its connection is closed.
    pub fn error(text: &str) -> Self {
        Self::new([("error", text)])
    }

    /// Parses the fields in `bytes`, which follow the header's length. Invalid UTF-8 is replaced.
    ///
    /// # Errors
    /// `Format` for a field that exceeds `bytes` or has no `=`.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let mut fields = Vec::new();
        let mut rest = bytes;
        while !rest.is_empty() {
            let (length, after) = rest
                .split_first_chunk()
                .ok_or_else(|| Error::format("the TCPROS header ends within the length of a field"))?;
            let length = u32::from_le_bytes(*length) as usize;
            let (field, after) = after.split_at_checked(length).ok_or_else(|| {
                Error::format(format!(
                    "the TCPROS header has a field of {length} bytes, but only {} are left",
                    after.len()
                ))
            })?;
            let equals = field
                .iter()
                .position(|byte| *byte == b'=')
                .ok_or_else(|| Error::format("the TCPROS header has a field without ="))?;
            let (name, value) = field.split_at(equals);
            let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
            fields.push((text(name), text(value.get(1..).unwrap_or_default())));
            rest = after;
        }
        Ok(Self(fields))
    }

    /// Returns the header with its length prefix.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = vec![0; 4];
        for (name, value) in &self.0 {
            bytes.extend(((name.len() + value.len() + 1) as u32).to_le_bytes());
            bytes.extend([name.as_bytes(), b"=", value.as_bytes()].concat());
        }
        let length = (bytes.len() - 4) as u32;
        if let Some(start) = bytes.first_chunk_mut() {
            *start = length.to_le_bytes();
        }
        bytes
    }

    /// Returns the field `name`; of several, the last.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.iter().rev().find(|(found, _)| found == name).map(|(_, value)| value.as_str())
    }

    /// Returns the field `name`.
    ///
    /// # Errors
    /// `Format` when it is missing.
    pub fn need(&self, name: &str) -> Result<&str> {
        self.get(name).ok_or_else(|| Error::format(format!("the TCPROS header has no field {name}")))
    }

    /// Reads the header at the start of a connection.
    ///
    /// # Errors
    /// `Format` for an invalid header or one above 1 MiB, `Network` for a peer that disconnects or is too slow.
    pub fn read(stream: &mut Timed<'_>) -> Result<Self> {
        let broken =
            |error| Error::network("the peer disconnected before its TCPROS header").with_source(error);
        let mut length = [0; 4];
        stream.read_exact(&mut length).map_err(broken)?;
        let length = u32::from_le_bytes(length);
        if length > MOST_HEADER {
            return Err(Error::format(format!(
                "the TCPROS header has {length} bytes; check that the peer is a ROS node"
            )));
        }
        let mut bytes = Vec::new();
        read_body(stream, length as usize, &mut bytes).map_err(broken)?;
        Self::from_bytes(&bytes)
    }

    /// Sends the header.
    ///
    /// # Errors
    /// `Network` when the peer has gone.
    pub fn write(&self, mut stream: &TcpStream) -> Result<()> {
        let sent = stream.write_all(&self.to_bytes());
        sent.map_err(|error| {
            Error::network("the peer disconnected within the TCPROS handshake").with_source(error)
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn headers_come_back(fields: Vec<(String, String)>) {
            let named = fields.into_iter().map(|(name, value)| (name.replace('=', ""), value));
            let header = Header(named.collect());
            prop_assert_eq!(Header::from_bytes(&header.to_bytes()[4..]).unwrap(), header);
        }

        #[test]
        fn any_bytes_are_refused_or_read(bytes: Vec<u8>) {
            let _ = Header::from_bytes(&bytes);
        }
    }

    #[test]
    fn bytes_equal_the_example_of_the_wiki() {
        // The example of the page on connection headers.
        let header = Header::new([("callerid", "/rostopic_4767_1316912741557"), ("latching", "1")]);
        let bytes = header.to_bytes();
        assert_eq!(bytes[..4], [0x37, 0, 0, 0]);
        assert_eq!(bytes[4..17], *b"\x25\0\0\0callerid=");
        assert_eq!(header.get("latching"), Some("1"));
        assert!(header.need("topic").is_err());
    }

    #[test]
    fn bad_headers_are_refused() {
        for bytes in
            [b"\x01".as_slice(), b"\x05\0\0\0a=b", b"\xff\xff\xff\xffa=b", b"\x01\0\0\0a", b"\0\0\0\0"]
        {
            assert!(Header::from_bytes(bytes).is_err());
        }
        let odd = Header::from_bytes(b"\x03\0\0\0a=\xff").unwrap();
        assert_eq!(odd.get("a"), Some("\u{fffd}"));
    }
}
