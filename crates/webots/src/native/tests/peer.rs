//! A peer whose answers are known before, and that keeps what it is sent.

use std::io::{Cursor, Read, Result, Write};
use std::sync::{Arc, Mutex};

/// What a [`Peer`] was sent.
pub(super) type Sent = Arc<Mutex<Vec<u8>>>;

pub(super) struct Peer {
    answers: Cursor<Vec<u8>>,
    sent: Sent,
}

impl Peer {
    pub(super) fn new(answers: Vec<u8>) -> (Self, Sent) {
        let sent = Sent::default();
        (Self { answers: Cursor::new(answers), sent: sent.clone() }, sent)
    }
}

impl Read for Peer {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        self.answers.read(buffer)
    }
}

impl Write for Peer {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.sent.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Returns the bytes of the lines of a golden file that begin with `direction`.
pub(super) fn golden(text: &str, direction: char) -> Vec<u8> {
    let lines = text.lines().filter(|line| line.starts_with(direction));
    let digits = lines.flat_map(|line| line.split_once(" | ").unwrap().1.as_bytes().chunks(2));
    digits.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap()).collect()
}

pub(super) const OLD: &str = include_str!("../../../tests/golden/r2023a.txt");
pub(super) const STATED: &str = include_str!("../../../tests/golden/r2025a.txt");
