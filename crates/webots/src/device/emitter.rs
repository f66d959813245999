//! Emitters of packets.

use std::collections::VecDeque;

use opendr_engine::{Error, Result};

use super::channels;
use super::opcodes::CONFIGURE;
use crate::reader::Reader;
use crate::request::Request;

const SEND: u8 = 0;
const CHANNEL: u8 = 1;
const RANGE: u8 = 2;
const BUFFER_SIZE: u8 = 3;
const ALLOWED_CHANNELS: u8 = 4;

/// An emitter. Packets wait until its rate lets them pass.
#[derive(Debug, Clone, Default)]
pub(crate) struct Emitter {
    channel: i32,
    range: f64,
    /// Maximum bytes that wait; none is no limit.
    buffer_size: Option<usize>,
    /// Bytes per millisecond; none is no limit.
    byte_rate: Option<f64>,
    credit: f64,
    waiting: VecDeque<Vec<u8>>,
    waiting_bytes: usize,
}

impl Emitter {
    /// Queues a packet.
    pub fn send(&mut self, packet: &[u8]) -> Result<()> {
        let is_full = self.buffer_size.is_some_and(|size| self.waiting_bytes + packet.len() > size);
        if packet.is_empty() || is_full {
            return Err(Error::invalid_input(format!(
                "a packet of {} bytes cannot be sent: {} bytes wait in a buffer of {}",
                packet.len(),
                self.waiting_bytes,
                self.buffer_size.map_or("any size".to_owned(), |size| format!("{size} bytes"))
            )));
        }
        if self.waiting.is_empty() {
            self.credit = 0.0;
        }
        self.waiting_bytes += packet.len();
        self.waiting.push_back(packet.to_vec());
        Ok(())
    }

    pub(super) fn write(&mut self, step_ms: u32, request: &mut Request) {
        if let Some(rate) = self.byte_rate.filter(|_| !self.waiting.is_empty()) {
            self.credit += rate * f64::from(step_ms);
        }
        while let Some(packet) = self.waiting.pop_front() {
            if self.byte_rate.is_some() && packet.len() as f64 > self.credit {
                self.waiting.push_front(packet);
                break;
            }
            request.u8(SEND);
            request.i32(self.channel);
            request.f64(self.range);
            request.u32(packet.len() as u32);
            request.data(&packet);
            self.credit -= packet.len() as f64;
            self.waiting_bytes -= packet.len();
        }
    }

    pub(super) fn apply_message(&mut self, command: u8, reader: &mut Reader<'_>) -> Result<bool> {
        match command {
            CONFIGURE => {
                self.buffer_size = usize::try_from(reader.i32()?).ok();
                self.channel = reader.i32()?;
                self.byte_rate = Some(reader.f64()?).filter(|rate| *rate >= 0.0);
                self.range = reader.f64()?;
                let _max_range = reader.f64()?;
                channels::skip(reader)?;
            }
            CHANNEL => self.channel = reader.i32()?,
            RANGE => self.range = reader.f64()?,
            BUFFER_SIZE => self.buffer_size = usize::try_from(reader.i32()?).ok(),
            ALLOWED_CHANNELS => channels::skip(reader)?,
            _ => return Ok(false),
        }
        Ok(true)
    }
}
