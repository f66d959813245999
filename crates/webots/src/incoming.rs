//! Reading of bytes whose number the peer states.

use std::io::{ErrorKind, Read};

use opendr_engine::{Error, Result};

/// Bytes that are read at once: what a peer states is allocated only as it arrives.
const PIECE: usize = 1 << 16;

/// Overwrites `buffer` by `size` bytes, which may be more than it has, but not fewer.
pub(crate) fn receive(stream: &mut impl Read, buffer: &mut Vec<u8>, size: usize) -> Result<()> {
    let mut at = 0;
    while at < size {
        let end = size.min(at + PIECE);
        if buffer.len() < end {
            buffer.resize(end, 0);
        }
        stream.read_exact(&mut buffer[at..end]).map_err(|error| lost(&error))?;
        at = end;
    }
    Ok(())
}

/// Reads an array.
pub(crate) fn array<const N: usize>(stream: &mut impl Read) -> Result<[u8; N]> {
    let mut array = [0; N];
    stream.read_exact(&mut array).map_err(|error| lost(&error))?;
    Ok(array)
}

/// Returns the error of a connection that ended or fell silent.
pub(crate) fn lost(error: &std::io::Error) -> Error {
    match error.kind() {
        ErrorKind::UnexpectedEof
        | ErrorKind::ConnectionReset
        | ErrorKind::BrokenPipe
        | ErrorKind::ConnectionAborted => Error::network("Webots closed the connection before it answered"),
        ErrorKind::WouldBlock | ErrorKind::TimedOut => {
            Error::network("Webots did not answer in time; is the simulation paused?")
        }
        _ => Error::network(format!("the connection to Webots failed: {error}")),
    }
}
