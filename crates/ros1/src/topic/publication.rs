//! Published topics.

use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

use super::outbox::Outbox;
use crate::TopicType;
use crate::context::Context;
use crate::lock::{lock, wait};
use crate::tasks::Cancel;
use crate::tcpros::Header;
use crate::types::agree;

/// Maximum number of spare buffers for further messages.
const MOST_SPARE: usize = 4;

/// A published topic with its subscribers.
#[derive(Debug)]
pub(crate) struct Publication {
    pub topic: String,
    pub kind: TopicType,
    pub latched: AtomicBool,
    pub queue_size: AtomicUsize,
    /// Number of the owner's handles.
    pub handles: AtomicUsize,
    pub dropped: AtomicU64,
    subscribers: Mutex<Subscribers>,
    joined: Condvar,
    spare: Mutex<Vec<Arc<Vec<u8>>>>,
}

#[derive(Debug, Default)]
struct Subscribers {
    outboxes: Vec<Arc<Outbox>>,
    /// Last message of a latched topic.
    last: Option<Arc<Vec<u8>>>,
    closed: bool,
}

impl Publication {
    pub fn new(topic: &str, kind: TopicType, latched: bool, queue_size: usize) -> Self {
        Self {
            topic: topic.to_owned(),
            kind,
            latched: AtomicBool::new(latched),
            queue_size: AtomicUsize::new(queue_size),
            handles: AtomicUsize::new(1),
            dropped: AtomicU64::new(0),
            subscribers: Mutex::default(),
            joined: Condvar::new(),
            spare: Mutex::default(),
        }
    }

    /// Registers the topic with the master.
    pub fn register(&self, context: &Context) -> Result<()> {
        let params =
            [self.topic.as_str().into(), self.kind.name.as_str().into(), context.api_uri.as_str().into()];
        context.register("registerPublisher", &params).map(|_| ())
    }

    /// Returns whether a message would be sent or latched.
    pub fn has_receivers(&self) -> bool {
        self.latched.load(Ordering::Relaxed) || !lock(&self.subscribers).outboxes.is_empty()
    }

    /// Queues `message` for every subscriber.
    pub fn publish(&self, message: &Arc<Vec<u8>>) -> Result<()> {
        let mut subscribers = lock(&self.subscribers);
        if subscribers.closed {
            return Err(Error::network(format!(
                "{} is no longer published: its node was shut down",
                self.topic
            )));
        }
        if self.latched.load(Ordering::Relaxed) {
            subscribers.last = Some(Arc::clone(message));
        }
        for outbox in &subscribers.outboxes {
            if outbox.push(Arc::clone(message)) {
                self.dropped.fetch_add(1, Ordering::Relaxed);
            }
        }
        Ok(())
    }

    /// Copies `bytes` into a buffer that is free again, or a new one.
    pub fn buffer(&self, bytes: &[u8]) -> Arc<Vec<u8>> {
        let mut spare = lock(&self.spare);
        let free = spare.iter_mut().position(|buffer| Arc::get_mut(buffer).is_some());
        let mut buffer = free.map(|at| spare.swap_remove(at)).unwrap_or_default();
        drop(spare);
        match Arc::get_mut(&mut buffer) {
            // The buffer of one long message is not kept for short ones.
            Some(vec) if vec.capacity() / 8 <= bytes.len().max(1 << 10) => {
                vec.clear();
                vec.extend_from_slice(bytes);
            }
            _ => buffer = Arc::new(bytes.to_vec()),
        }
        let mut spare = lock(&self.spare);
        if spare.len() < MOST_SPARE {
            spare.push(Arc::clone(&buffer));
        }
        buffer
    }

    /// Returns the current subscribers.
    pub fn outboxes(&self) -> Vec<Arc<Outbox>> {
        lock(&self.subscribers).outboxes.clone()
    }

    /// Waits for `count` subscribers, for at most `time`; returns whether there are so many.
    pub fn wait_for_subscribers(&self, count: usize, time: Duration) -> bool {
        let until = Instant::now() + time;
        let mut subscribers = lock(&self.subscribers);
        while subscribers.outboxes.len() < count && !subscribers.closed {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            subscribers = wait(&self.joined, subscribers, left);
        }
        !subscribers.closed
    }

    /// Closes the topic to further messages; queued ones are still sent.
    pub fn close(&self) {
        let mut subscribers = lock(&self.subscribers);
        subscribers.closed = true;
        subscribers.outboxes.iter().for_each(|outbox| outbox.close());
        self.joined.notify_all();
    }

    /// Checks that the type in the `header` of a subscriber matches.
    fn clash(&self, header: &Header) -> Result<()> {
        let sum = header.need("md5sum")?;
        let name = header.get("type").unwrap_or("*");
        if agree(sum, &self.kind.md5sum) && agree(name, &self.kind.name) {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "{} requested {} as {name:.80} with md5 sum {sum:.40}, but this node publishes {} with {}; \
             build both against the same definition",
            header.get("callerid").unwrap_or("a subscriber"),
            self.topic,
            self.kind.name,
            self.kind.md5sum
        )))
    }

    /// Serves the subscriber that sent `header` until it disconnects.
    pub fn serve(
        &self,
        context: &Context,
        header: &Header,
        stream: &TcpStream,
        cancel: &Cancel,
    ) -> Result<()> {
        if let Err(error) = self.clash(header) {
            Header::error(&error.to_string()).write(stream)?;
            return Err(error);
        }
        let latching = if self.latched.load(Ordering::Relaxed) { "1" } else { "0" };
        Header::new([
            ("callerid", context.names.node()),
            ("topic", &self.topic),
            ("type", &self.kind.name),
            ("md5sum", &self.kind.md5sum),
            ("latching", latching),
            ("message_definition", &self.kind.definition),
        ])
        .write(stream)?;
        stream.set_read_timeout(None)?;
        stream.set_write_timeout(None)?;
        cancel.drain();
        let caller = header.get("callerid").unwrap_or("unnamed");
        let ends = super::link::ends(stream);
        let queue_size = self.queue_size.load(Ordering::Relaxed);
        let outbox = Arc::new(Outbox::new(context.connection_id(), caller, ends, queue_size));
        if self.join(&outbox) {
            outbox.send_all(stream);
        }
        lock(&self.subscribers).outboxes.retain(|other| !Arc::ptr_eq(other, &outbox));
        Ok(())
    }

    fn join(&self, outbox: &Arc<Outbox>) -> bool {
        let mut subscribers = lock(&self.subscribers);
        if subscribers.closed {
            return false;
        }
        if let Some(last) = &subscribers.last {
            outbox.push(Arc::clone(last));
        }
        subscribers.outboxes.push(Arc::clone(outbox));
        self.joined.notify_all();
        true
    }
}
