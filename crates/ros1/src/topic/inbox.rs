//! What has come in and waits for the owner.

use std::collections::VecDeque;
use std::fmt;
use std::ops::Deref;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, Weak};
use std::time::{Duration, Instant, SystemTime};

use crate::lock::{lock, wait};

/// Buffers kept beside those of the queue: one being read into, one in the owner's hands.
const MORE_SPARE: usize = 2;

/// Who publishes, as its connection header says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PublisherInfo {
    /// The publishing node's name.
    pub caller_id: String,
    /// The address of its XML-RPC server.
    pub uri: String,
    /// The messages' type.
    pub type_name: String,
    /// The type's md5 sum.
    pub md5sum: String,
    /// The type's definition, where the publisher tells it.
    pub definition: String,
    /// Whether the first message was there before the connection.
    pub latching: bool,
}

/// A message as it came.
#[derive(Debug)]
pub struct ReceivedMessage {
    /// The message in ROS 1's format.
    pub bytes: MessageBytes,
    /// Who sent it.
    pub publisher: Arc<PublisherInfo>,
    /// When its last byte had come in.
    pub received_at: SystemTime,
}

/// The bytes of a message, in a buffer that goes back to its subscription.
pub struct MessageBytes {
    bytes: Vec<u8>,
    home: Weak<Inbox>,
}

impl MessageBytes {
    /// The bytes for good, without a copy.
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

/// The queue of one subscription.
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
    /// A queue of at most `most` messages.
    pub fn new(most: usize) -> Self {
        Self {
            queue: Mutex::default(),
            changed: Condvar::new(),
            spare: Mutex::default(),
            most,
            dropped: AtomicU64::new(0),
        }
    }

    /// A buffer to read the next message of `length` bytes into.
    pub fn buffer(&self, length: usize) -> Vec<u8> {
        let buffer = lock(&self.spare).pop().unwrap_or_default();
        // One long message does not keep its memory for short ones.
        if buffer.capacity() / 8 > length.max(1 << 10) { Vec::new() } else { buffer }
    }

    fn give_back(&self, buffer: Vec<u8>) {
        let mut spare = lock(&self.spare);
        if spare.len() < MORE_SPARE {
            spare.push(buffer);
        }
    }

    /// Puts a message at the end; the oldest goes when there are too many.
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

    /// The next message, waited for until `until`, without an end when there is none.
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

    /// The newest message, without those before it.
    pub fn pop_newest(&self) -> Option<ReceivedMessage> {
        let mut messages = std::mem::take(&mut lock(&self.queue).messages);
        let newest = messages.pop_back();
        self.dropped.fetch_add(messages.len() as u64, Ordering::Relaxed);
        newest
    }

    /// Takes no more messages.
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
    fn a_slow_owner_gets_the_newest_and_buffers_go_round() {
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
