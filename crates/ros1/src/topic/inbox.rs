//! Queue of received messages.

use std::collections::VecDeque;
use std::fmt;
use std::ops::Deref;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, Weak};
use std::time::{Duration, Instant, SystemTime};

use crate::lock::{lock, wait};

/// Number of buffers besides those of the queue: one being filled, one in use by the owner.
const MORE_SPARE: usize = 2;

/// Publisher of a message, from its connection header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PublisherInfo {
    /// Name of the publishing node.
    pub caller_id: String,
    /// URI of its XML-RPC server.
    pub uri: String,
    /// Message type.
    pub type_name: String,
    /// md5 sum of the type.
    pub md5sum: String,
    /// Definition of the type, if the publisher sends it.
    pub definition: String,
    /// Whether the topic is latched, so that the first message may be older than the connection.
    pub latching: bool,
}

/// A received message.
#[derive(Debug)]
pub struct ReceivedMessage {
    /// The message in ROS 1's format.
    pub bytes: MessageBytes,
    /// Publisher of the message.
    pub publisher: Arc<PublisherInfo>,
    /// Time of arrival of the last byte.
    pub received_at: SystemTime,
}

/// Bytes of a message, in a buffer that returns to its subscription when dropped.
pub struct MessageBytes {
    bytes: Vec<u8>,
    home: Weak<Inbox>,
}

impl MessageBytes {
    /// Takes the bytes out, without a copy.
    pub fn into_vec(mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }
}

impl Deref for MessageBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.bytes
    }
}

impl fmt::Debug for MessageBytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.bytes.len())
    }
}

impl Drop for MessageBytes {
    fn drop(&mut self) {
        if self.bytes.capacity() > 0
            && let Some(home) = self.home.upgrade()
        {
            home.give_back(std::mem::take(&mut self.bytes));
        }
    }
}

/// Queue of one subscription.
#[derive(Debug)]
pub(crate) struct Inbox {
    queue: Mutex<Queue>,
    changed: Condvar,
    spare: Mutex<Vec<Vec<u8>>>,
    most: usize,
    pub dropped: AtomicU64,
}

#[derive(Debug, Default)]
struct Queue {
    messages: VecDeque<ReceivedMessage>,
    closed: bool,
}

impl Inbox {
    /// Creates a queue of at most `most` messages.
    pub fn new(most: usize) -> Self {
        Self {
            queue: Mutex::default(),
            changed: Condvar::new(),
            spare: Mutex::default(),
            most,
            dropped: AtomicU64::new(0),
        }
    }

    /// Returns a buffer for the next message of `length` bytes.
    pub fn buffer(&self, length: usize) -> Vec<u8> {
        let buffer = lock(&self.spare).pop().unwrap_or_default();
        // The buffer of one long message is not kept for short ones.
        if buffer.capacity() / 8 > length.max(1 << 10) { Vec::new() } else { buffer }
    }

    fn give_back(&self, buffer: Vec<u8>) {
        let mut spare = lock(&self.spare);
        if spare.len() < MORE_SPARE {
            spare.push(buffer);
        }
    }

    /// Appends a message; drops the oldest if the queue is full.
    pub fn push(self: &Arc<Self>, bytes: Vec<u8>, publisher: Arc<PublisherInfo>) {
        let bytes = MessageBytes { bytes, home: Arc::downgrade(self) };
        let message = ReceivedMessage { bytes, publisher, received_at: SystemTime::now() };
        let mut queue = lock(&self.queue);
        if queue.closed {
            return;
        }
        let mut oldest = None;
        if queue.messages.len() >= self.most {
            oldest = queue.messages.pop_front();
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
        queue.messages.push_back(message);
        self.changed.notify_one();
        drop(queue);
        drop(oldest);
    }

    /// Waits for the next message until `until`, or without limit.
    pub fn pop(&self, until: Option<Instant>) -> Option<ReceivedMessage> {
        let mut queue = lock(&self.queue);
        loop {
            if let Some(message) = queue.messages.pop_front() {
                return Some(message);
            }
            let left = match until {
                Some(until) => until.saturating_duration_since(Instant::now()),
                None => Duration::from_secs(3600),
            };
            if queue.closed || left.is_zero() {
                return None;
            }
            queue = wait(&self.changed, queue, left);
        }
    }

    /// Returns the newest message and drops those before it.
    pub fn pop_newest(&self) -> Option<ReceivedMessage> {
        let mut messages = std::mem::take(&mut lock(&self.queue).messages);
        let newest = messages.pop_back();
        self.dropped.fetch_add(messages.len() as u64, Ordering::Relaxed);
        newest
    }

    /// Closes the queue to further messages.
    pub fn close(&self) {
        lock(&self.queue).closed = true;
        self.changed.notify_all();
    }

    pub fn is_closed(&self) -> bool {
        lock(&self.queue).closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn publisher() -> Arc<PublisherInfo> {
        let text = String::new;
        Arc::new(PublisherInfo {
            caller_id: text(),
            uri: text(),
            type_name: text(),
            md5sum: text(),
            definition: text(),
            latching: false,
        })
    }

    #[test]
    fn a_slow_owner_gets_the_newest_and_buffers_are_reused() {
        let inbox = Arc::new(Inbox::new(2));
        for at in 0..5 {
            let mut buffer = inbox.buffer(1);
            buffer.clear();
            buffer.push(at);
            inbox.push(buffer, publisher());
        }
        assert_eq!(inbox.dropped.load(Ordering::Relaxed), 3);
        let message = inbox.pop(Some(Instant::now())).unwrap();
        assert_eq!(*message.bytes, [3]);
        let place = message.bytes.as_ptr();
        drop(message);
        let again = inbox.buffer(1);
        assert_eq!(again.as_ptr(), place);
        assert_eq!(inbox.pop_newest().unwrap().bytes.into_vec(), [4]);
        assert!(inbox.pop(Some(Instant::now())).is_none());
        inbox.close();
        assert!(inbox.pop(None).is_none());
    }

    #[test]
    fn a_long_message_does_not_keep_its_memory() {
        let inbox = Arc::new(Inbox::new(1));
        inbox.push(Vec::with_capacity(1 << 20), publisher());
        drop(inbox.pop_newest());
        assert_eq!(inbox.buffer(100).capacity(), 0);
    }
}
