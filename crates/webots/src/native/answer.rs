//! Answers of Webots: over TCP in chunks with images between them, over a Unix socket in one piece.

use std::io::{ErrorKind, Read};

use opendr_engine::{Error, Result};

use super::robot::Robot;
use crate::device::State;

/// How answers are framed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Framing {
    Tcp,
    Ipc,
}

const DATA: u8 = 0;
const IMAGE: u8 = 1;
const COLOUR_OR_RANGE: u8 = 0;
/// Longest messages of one answer, without images.
const MAX_DATA: usize = 1 << 24;
/// Bytes that are read at once: what a peer states is allocated only as it arrives.
const PIECE: usize = 1 << 16;

/// Reads an answer; `data` is a buffer that is used again. Returns the step in ms, below 0 for a message that answers nothing.
pub(crate) fn read(
    stream: &mut impl Read,
    framing: Framing,
    robot: &mut Robot,
    data: &mut Vec<u8>,
) -> Result<i32> {
    data.clear();
    match framing {
        Framing::Ipc => {
            let size = i32::from_le_bytes(array(stream)?);
            let size = size.checked_sub(4).unwrap_or(-1);
            extend(stream, data, size)?;
        }
        Framing::Tcp => {
            let chunks = u16::from_le_bytes(array(stream)?);
            let size = i32::from_le_bytes(array(stream)?);
            for _ in 0..chunks {
                chunk(stream, robot, data)?;
            }
            if usize::try_from(size) != Ok(data.len()) {
                return Err(Error::format(format!(
                    "an answer states {size} bytes of messages, but has {}",
                    data.len()
                )));
            }
        }
    }
    let Some((delay, messages)) = data.split_first_chunk() else {
        return Err(Error::format(format!("an answer of {} bytes has no step", data.len())));
    };
    let delay = i32::from_le_bytes(*delay);
    robot.read(messages)?;
    Ok(delay)
}

fn chunk(stream: &mut impl Read, robot: &mut Robot, data: &mut Vec<u8>) -> Result<()> {
    let size = i32::from_le_bytes(array(stream)?);
    match array::<1>(stream)?[0] {
        DATA => extend(stream, data, size),
        IMAGE => {
            let tag = u16::from_le_bytes(array(stream)?);
            let command = array::<1>(stream)?[0];
            let device = robot.device(tag)?;
            let (State::Imager(imager), COLOUR_OR_RANGE) = (&mut device.state, command) else {
                return Err(Error::format(format!(
                    "device {:?} sent an image of kind {command}",
                    device.name
                )));
            };
            let size =
                usize::try_from(size).map_err(|_| Error::format(format!("an image of {size} bytes")))?;
            let buffer =
                imager.buffer(size).map_err(|error| error.context(format!("device {:?}", device.name)))?;
            stream.read_exact(buffer).map_err(|error| lost(&error))
        }
        other => {
            Err(Error::format(format!("an answer has a chunk of type {other}; is the port that of Webots?")))
        }
    }
}

/// Appends `size` bytes.
fn extend(stream: &mut impl Read, data: &mut Vec<u8>, size: i32) -> Result<()> {
    let stated = usize::try_from(size).ok().filter(|size| data.len() + size <= MAX_DATA);
    let Some(mut left) = stated else {
        return Err(Error::format(format!(
            "{size} bytes of messages are not possible; is the port that of Webots?"
        )));
    };
    while left > 0 {
        let (start, piece) = (data.len(), left.min(PIECE));
        data.resize(start + piece, 0);
        stream.read_exact(&mut data[start..]).map_err(|error| lost(&error))?;
        left -= piece;
    }
    Ok(())
}

fn array<const N: usize>(stream: &mut impl Read) -> Result<[u8; N]> {
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
