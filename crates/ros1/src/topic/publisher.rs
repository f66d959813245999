//! Handles of published topics.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use opendr_engine::{Error, Result};

use super::Publication;
use crate::TopicType;
use crate::graph::Graph;
use crate::lock::lock;

/// Options of a publisher.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PublisherOptions {
    /// Whether a new subscriber receives the last message at once.
    pub latched: bool,
    /// Maximum number of queued messages per subscriber, at least 1; the oldest is dropped.
    pub queue_size: usize,
}

impl Default for PublisherOptions {
    fn default() -> Self {
        Self { latched: false, queue_size: 1 }
    }
}

/// Handle of a published topic. Dropping the last handle ends the publication; queued messages are still sent for a short time.
pub struct Publisher {
    graph: Arc<Graph>,
    publication: Arc<Publication>,
}

impl Publisher {
    /// Publishes the topic with the full name `topic`.
    pub(crate) fn new(
        graph: &Arc<Graph>,
        topic: &str,
        kind: TopicType,
        options: PublisherOptions,
    ) -> Result<Self> {
        kind.check_concrete()?;
        if options.queue_size == 0 {
            return Err(Error::invalid_param(
                "queue_size is 0; give at least 1, which keeps the newest message only",
            ));
        }
        let mut publications = lock(&graph.publications);
        graph.context.check_running()?;
        let publication = match publications.get(topic) {
            Some(there) if there.kind.md5sum == kind.md5sum && there.kind.name == kind.name => {
                there.handles.fetch_add(1, Ordering::Relaxed);
                there.latched.fetch_or(options.latched, Ordering::Relaxed);
                there.queue_size.fetch_max(options.queue_size, Ordering::Relaxed);
                return Ok(Self { graph: Arc::clone(graph), publication: Arc::clone(there) });
            }
            Some(there) => {
                return Err(Error::invalid_param(format!(
                    "this node already publishes {topic} as {}, not as {}",
                    there.kind.name, kind.name
                )));
            }
            None => Arc::new(Publication::new(topic, kind, options.latched, options.queue_size)),
        };
        publications.insert(topic.to_owned(), Arc::clone(&publication));
        drop(publications);
        // If the registration fails, dropping `publisher` removes the topic.
        let publisher = Self { graph: Arc::clone(graph), publication };
        publisher.publication.register(&graph.context)?;
        Ok(publisher)
    }

    /// Queues a copy of `message` for every subscriber, without waiting.
    ///
    /// # Errors
    /// `InvalidInput` for a message longer than `NodeOptions::max_message_bytes`, `Network` after the shutdown of the node.
    pub fn publish(&self, message: &[u8]) -> Result<()> {
        self.check(message.len())?;
        if !self.publication.has_receivers() && !self.graph.context.is_ended() {
            return Ok(());
        }
        self.publication.publish(&self.publication.buffer(message))
    }

    /// As [`Publisher::publish`], without a copy.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn publish_owned(&self, message: Vec<u8>) -> Result<()> {
        self.check(message.len())?;
        self.publication.publish(&Arc::new(message))
    }

    fn check(&self, length: usize) -> Result<()> {
        let most = self.graph.context.max_message_bytes.min(u32::MAX as usize);
        if length <= most {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "a message on {} has {length} bytes; at most {most} are allowed (NodeOptions::max_message_bytes)",
            self.topic()
        )))
    }

    /// Returns the topic's full name.
    pub fn topic(&self) -> &str {
        &self.publication.topic
    }

    /// Returns the number of connected subscribers.
    pub fn subscriber_count(&self) -> usize {
        self.publication.outboxes().len()
    }

    /// Waits for `count` connected subscribers, for at most `time`; returns whether there are so many.
    pub fn wait_for_subscribers(&self, count: usize, time: Duration) -> bool {
        self.publication.wait_for_subscribers(count, time)
    }

    /// Returns the number of messages dropped for slow subscribers, summed over all.
    pub fn dropped(&self) -> u64 {
        self.publication.dropped.load(Ordering::Relaxed)
    }
}

impl Drop for Publisher {
    fn drop(&mut self) {
        let mut publications = lock(&self.graph.publications);
        if self.publication.handles.fetch_sub(1, Ordering::Relaxed) > 1 {
            return;
        }
        publications.retain(|_, other| !Arc::ptr_eq(other, &self.publication));
        drop(publications);
        self.publication.close();
        let params = [self.topic().into(), self.graph.context.api_uri.as_str().into()];
        self.graph.context.unregister("unregisterPublisher", &params);
    }
}

impl fmt::Debug for Publisher {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Publisher").field(&self.topic()).finish()
    }
}
