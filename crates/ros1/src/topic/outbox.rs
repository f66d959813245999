//! Queue of messages to one subscriber.

use std::collections::VecDeque;
use std::io::ErrorKind;
use std::net::TcpStream;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use crate::lock::{lock, wait};
use crate::tcpros::write_frame;

/// Interval at which an idle publisher checks that its subscriber is connected.
const LOOK_TIME: Duration = Duration::from_millis(500);

/// Queue of one connection, with its statistics for getBusStats and getBusInfo.
#[derive(Debug)]
pub(crate) struct Outbox {
    pub id: u32,
    /// Name of the subscriber.
    pub caller_id: String,
    /// Both ends of the connection, as text.
    pub ends: String,
    pub sent_bytes: AtomicU64,
    pub sent_messages: AtomicU64,
    /// Number of messages dropped because the subscriber was too slow.
    pub dropped: AtomicU64,
    queue: Mutex<Queue>,
    changed: Condvar,
    most: usize,
}

#[derive(Debug, Default)]
struct Queue {
    messages: VecDeque<Arc<Vec<u8>>>,
    closed: bool,
}

enum Next {
    Message(Arc<Vec<u8>>),
    Nothing,
    Closed,
}

impl Outbox {
    /// Creates a queue of at most `most` messages.
    pub fn new(id: u32, caller_id: &str, ends: String, most: usize) -> Self {
        Self {
            id,
            caller_id: caller_id.to_owned(),
            ends,
            sent_bytes: AtomicU64::new(0),
            sent_messages: AtomicU64::new(0),
            dropped: AtomicU64::new(0),
            queue: Mutex::default(),
            changed: Condvar::new(),
            most,
        }
    }

    /// Appends `message`; returns whether the oldest was dropped.
    pub fn push(&self, message: Arc<Vec<u8>>) -> bool {
        let mut queue = lock(&self.queue);
        let full = queue.messages.len() >= self.most;
        if full {
            queue.messages.pop_front();
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
        queue.messages.push_back(message);
        self.changed.notify_one();
        full
    }

    /// Closes the connection after the queued messages are sent.
    pub fn close(&self) {
        lock(&self.queue).closed = true;
        self.changed.notify_one();
    }

    fn next(&self) -> Next {
        let mut queue = lock(&self.queue);
        if queue.messages.is_empty() && !queue.closed {
            queue = wait(&self.changed, queue, LOOK_TIME);
        }
        match queue.messages.pop_front() {
            Some(message) => Next::Message(message),
            None if queue.closed => Next::Closed,
            None => Next::Nothing,
        }
    }

    /// Sends messages until the subscriber disconnects or the queue is closed.
    pub fn send_all(&self, mut stream: &TcpStream) {
        loop {
            match self.next() {
                Next::Message(message) => {
                    if write_frame(&mut stream, b"", &message).is_err() {
                        return;
                    }
                    self.sent_messages.fetch_add(1, Ordering::Relaxed);
                    self.sent_bytes.fetch_add(message.len() as u64 + 4, Ordering::Relaxed);
                }
                Next::Nothing if is_open(stream) => {}
                Next::Nothing | Next::Closed => return,
            }
        }
    }
}

/// Returns whether a peer that sends no data is still connected.
fn is_open(stream: &TcpStream) -> bool {
    if stream.set_nonblocking(true).is_err() {
        return false;
    }
    let seen = stream.peek(&mut [0]);
    let back = stream.set_nonblocking(false);
    let open = match seen {
        Ok(read) => read > 0,
        Err(error) => matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted),
    };
    open && back.is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_queue_drops_the_oldest() {
        let outbox = Outbox::new(0, "/a", String::new(), 2);
        let dropped: Vec<bool> = (0..4).map(|at| outbox.push(Arc::new(vec![at]))).collect();
        assert_eq!(dropped, [false, false, true, true]);
        assert_eq!(outbox.dropped.load(Ordering::Relaxed), 2);
        outbox.close();
        for at in [2, 3] {
            assert!(matches!(outbox.next(), Next::Message(message) if *message == [at]));
        }
        assert!(matches!(outbox.next(), Next::Closed));
    }
}
