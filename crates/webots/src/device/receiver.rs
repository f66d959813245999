//! Receivers of packets.

use std::collections::VecDeque;

use opendr_engine::{Error, Result};

use super::channels;
use super::opcodes::{CONFIGURE, write_period};
use crate::reader::Reader;
use crate::request::Request;

const RECEIVE: u8 = 1;
/// Maximum bytes that wait in a receiver without a limit of its own.
const MAX_WAITING: usize = 1 << 24;

/// A receiver. As in Webots, packets that its buffer does not hold are dropped.
#[derive(Debug, Clone, Default)]
pub(crate) struct Receiver {
    buffer_size: Option<usize>,
    packets: VecDeque<Vec<u8>>,
    /// Packets that were read, whose buffers are used again.
    spare: Vec<Vec<u8>>,
    waiting_bytes: usize,
    new_period: Option<u16>,
}

impl Receiver {
    /// Replaces `packet` by the oldest packet; returns false if there is none.
    pub fn receive(&mut self, packet: &mut Vec<u8>) -> bool {
        let Some(mut oldest) = self.packets.pop_front() else { return false };
        self.waiting_bytes -= oldest.len();
        std::mem::swap(packet, &mut oldest);
        self.spare.push(oldest);
        true
    }

    pub(super) fn enable(&mut self, period_ms: u16) {
        self.new_period = Some(period_ms);
    }

    pub(super) fn write(&mut self, request: &mut Request) {
        write_period(&mut self.new_period, request);
    }

    pub(super) fn apply_message(&mut self, command: u8, reader: &mut Reader<'_>) -> Result<bool> {
        match command {
            CONFIGURE => {
                self.buffer_size = usize::try_from(reader.i32()?).ok();
                let _channel = reader.i32()?;
                channels::skip(reader)?;
            }
            RECEIVE => {
                let _channel = reader.i32()?;
                // Direction of the emitter, strength of the signal.
                reader.fill(&mut [0.0; 4])?;
                let size = reader.count(1)?;
                self.keep(reader.bytes(size)?)?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn keep(&mut self, bytes: &[u8]) -> Result<()> {
        let waiting = self.waiting_bytes + bytes.len();
        if waiting > MAX_WAITING || self.packets.len() >= MAX_WAITING / 16 {
            return Err(Error::format(format!(
                "{waiting} bytes in {} packets wait to be received; read them after each step",
                self.packets.len() + 1
            )));
        }
        if self.buffer_size.is_some_and(|size| waiting > size) {
            return Ok(());
        }
        let mut packet = self.spare.pop().unwrap_or_default();
        packet.clear();
        packet.extend_from_slice(bytes);
        self.packets.push_back(packet);
        self.waiting_bytes = waiting;
        Ok(())
    }
}
