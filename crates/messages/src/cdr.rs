//! CDR, the format of ROS 2 messages in DDS and recordings: a header of 4 bytes, then the fields, each aligned to its size (OMG
//! DDSI-RTPS 2.5, section 10; plain CDR, version 1).

use byteorder::{BigEndian, LittleEndian};
use cdr_encoding::CdrDeserializer;
use opendr_engine::{Error, Result};
use serde::Serialize;
use serde::de::{DeserializeOwned, DeserializeSeed};

use crate::{Message, MessageType};

/// Header of plain CDR, little-endian; the last two bytes are unused options.
const LITTLE_ENDIAN: [u8; 4] = [0, 1, 0, 0];

/// Writes a message as little-endian CDR with its header.
///
/// # Errors
/// `Internal` for a field that CDR cannot hold: more than 2^32 - 1 elements.
pub fn cdr_from_message(message: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes = LITTLE_ENDIAN.to_vec();
    cdr_encoding::to_writer::<_, LittleEndian, _>(&mut bytes, message)
        .map_err(|error| Error::internal(format!("writing a message as CDR: {error}")))?;
    Ok(bytes)
}

/// Reads CDR with its header, in either byte order. Bytes after the message are padding.
///
/// # Errors
/// `Format` for incomplete bytes, a length beyond the end, or text that is not UTF-8.
pub fn message_from_cdr<M: DeserializeOwned>(bytes: &[u8]) -> Result<M> {
    let (order, body) = split_header(bytes)?;
    let read = match order {
        Order::Little => cdr_encoding::from_bytes::<M, LittleEndian>(body),
        Order::Big => cdr_encoding::from_bytes::<M, BigEndian>(body),
    };
    read.map(|(message, _)| message).map_err(|error| unreadable(std::any::type_name::<M>(), bytes, &error))
}

/// As [`message_from_cdr`], for a type known at run time.
pub(crate) fn seeded_message_from_cdr(message_type: MessageType, bytes: &[u8]) -> Result<Message> {
    let (order, body) = split_header(bytes)?;
    let read = match order {
        Order::Little => message_type.deserialize(&mut CdrDeserializer::<LittleEndian>::new(body)),
        Order::Big => message_type.deserialize(&mut CdrDeserializer::<BigEndian>::new(body)),
    };
    read.map_err(|error| unreadable(message_type.ros2_name(), bytes, &error))
}

enum Order {
    Little,
    Big,
}

fn split_header(bytes: &[u8]) -> Result<(Order, &[u8])> {
    match bytes {
        [0, 1, _, _, body @ ..] => Ok((Order::Little, body)),
        [0, 0, _, _, body @ ..] => Ok((Order::Big, body)),
        [a, b, _, _, ..] => Err(Error::unsupported(format!(
            "the message has the representation {a:#04x} {b:#04x}; OpenDR reads plain CDR (0x00 0x00 and 0x00 0x01)"
        ))),
        _ => Err(Error::format(format!("{} bytes are too few for a message in CDR", bytes.len()))),
    }
}

#[cold]
fn unreadable(name: &str, bytes: &[u8], error: &cdr_encoding::Error) -> Error {
    Error::format(format!("{} bytes cannot be read as {name} in CDR: {error}", bytes.len()))
}
