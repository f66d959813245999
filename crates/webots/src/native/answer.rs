//! Answers of Webots: over TCP in chunks with images between them, over a Unix socket in one piece.

use std::io::Read;

use opendr_engine::{Error, Result};

use super::robot::Robot;
use crate::device::State;
use crate::incoming::{array, receive};

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

/// Messages of an answer; the bytes behind `length` are of earlier ones.
#[derive(Debug, Default)]
pub(crate) struct Data {
    pub(super) bytes: Vec<u8>,
    length: usize,
}

/// Reads an answer; `data` is a buffer that is used again. Returns the step in ms, below 0 for a message that answers nothing.
pub(crate) fn read(
    stream: &mut impl Read,
    framing: Framing,
    robot: &mut Robot,
    data: &mut Data,
) -> Result<i32> {
    data.length = 0;
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
            if usize::try_from(size) != Ok(data.length) {
                return Err(Error::format(format!(
                    "an answer states {size} bytes of messages, but has {}",
                    data.length
                )));
            }
        }
    }
    let Some((delay, messages)) = data.bytes[..data.length].split_first_chunk() else {
        return Err(Error::format(format!("an answer of {} bytes has no step", data.length)));
    };
    let delay = i32::from_le_bytes(*delay);
    robot.read(messages)?;
    Ok(delay)
}

fn chunk(stream: &mut impl Read, robot: &mut Robot, data: &mut Data) -> Result<()> {
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
            imager.receive(stream, size).map_err(|error| error.context(format!("device {:?}", device.name)))
        }
        other => {
            Err(Error::format(format!("an answer has a chunk of type {other}; is the port that of Webots?")))
        }
    }
}

/// Appends `size` bytes.
fn extend(stream: &mut impl Read, data: &mut Data, size: i32) -> Result<()> {
    let Some(size) = usize::try_from(size).ok().filter(|size| data.length + size <= MAX_DATA) else {
        return Err(Error::format(format!(
            "{size} bytes of messages are not possible; is the port that of Webots?"
        )));
    };
    if data.length == 0 {
        receive(stream, &mut data.bytes, size)?;
    } else {
        let mut more = Vec::new();
        receive(stream, &mut more, size)?;
        data.bytes.truncate(data.length);
        data.bytes.append(&mut more);
    }
    data.length += size;
    Ok(())
}
