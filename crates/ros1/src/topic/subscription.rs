//! The owner's handle on a topic that is subscribed to.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

use super::inbox::Inbox;
use super::{ReceivedMessage, Subscribed};
use crate::TopicType;
use crate::graph::Graph;
use crate::lock::lock;

/// How a topic is subscribed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubscriberOptions {
    /// Messages that wait for a slow owner before the oldest is dropped; 1 keeps the newest alone.
    pub queue_size: usize,
    /// Whether publishers are asked to send small messages at once.
    pub tcp_nodelay: bool,
}

impl Default for SubscriberOptions {
    fn default() -> Self {
        Self { queue_size: 1, tcp_nodelay: true }
    }
}

/// Messages of a topic, until it goes.
///
/// Publishers are read from all the time; who takes messages too slowly misses the oldest, and never holds up
/// a publisher.
pub struct Subscription {
    graph: Arc<Graph>,
    subscribed: Arc<Subscribed>,
}

impl Subscription {
    /// Subscribes to `topic`, a full name.
    pub(crate) fn new(
        graph: &Arc<Graph>,
        topic: &str,
        kind: TopicType,
        options: SubscriberOptions,
    ) -> Result<Self> {
        kind.check()?;
        if options.queue_size == 0 {
            return Err(Error::invalid_param("a queue_size of 0; give at least 1, the newest message alone"));
        }
        let inbox = Inbox::new(options.queue_size);
        let subscribed = Arc::new(Subscribed::new(graph, topic, kind, options.tcp_nodelay, inbox));
        let mut subscriptions = lock(&graph.subscriptions);
        if graph.is_ended() {
            return Err(Error::network("the node was shut down; create a new one"));
        }
        subscriptions.push(Arc::clone(&subscribed));
        drop(subscriptions);
        // A refused topic leaves again when `subscription` goes.
        let subscription = Self { graph: Arc::clone(graph), subscribed };
        subscription.subscribed.register(false)?;
        Ok(subscription)
    }

    /// The next message, waited for until there is one; nothing once the node is shut down.
    pub fn recv(&self) -> Option<ReceivedMessage> {
        self.subscribed.inbox.pop(None)
    }

    /// The next message, waited for `time` at most.
    pub fn recv_timeout(&self, time: Duration) -> Option<ReceivedMessage> {
        self.subscribed.inbox.pop(Instant::now().checked_add(time))
    }

    /// The next message, if there is one.
    pub fn try_recv(&self) -> Option<ReceivedMessage> {
        self.recv_timeout(Duration::ZERO)
    }

    /// The newest message, if there is one; those before it are dropped.
    pub fn latest(&self) -> Option<ReceivedMessage> {
        self.subscribed.inbox.pop_newest()
    }

    /// Calls `take` with every message, on a thread of its own, until the listener goes. What comes in while
    /// it is busy waits as the options say. A panic in it is told to `NodeOptions::on_problem`.
    ///
    /// # Errors
    /// `Network` once the node is shut down, `Io` when the system has no more threads.
    pub fn on_message(self, mut take: impl FnMut(ReceivedMessage) + Send + 'static) -> Result<Listener> {
        let (graph, subscribed) = (Arc::clone(&self.graph), Arc::clone(&self.subscribed));
        self.graph.tasks.spawn("listener", move |_| {
            while let Some(message) = subscribed.inbox.pop(None) {
                graph.guarded("the owner's function for messages", || take(message));
            }
        })?;
        Ok(Listener { subscription: self })
    }

    /// The topic's full name.
    pub fn topic(&self) -> &str {
        &self.subscribed.topic
    }

    /// How many publishers are connected.
    pub fn publisher_count(&self) -> usize {
        let links = self.subscribed.links();
        links.iter().filter(|link| link.connected.load(Ordering::Relaxed)).count()
    }

    /// How many messages have come in from the publishers there are now.
    pub fn received(&self) -> u64 {
        self.subscribed.links().iter().map(|link| link.received_messages.load(Ordering::Relaxed)).sum()
    }

    /// How many messages a slow owner has missed.
    pub fn dropped(&self) -> u64 {
        self.subscribed.inbox.dropped.load(Ordering::Relaxed)
    }

    /// Whether the node is shut down: no message will come any more.
    pub fn is_closed(&self) -> bool {
        self.subscribed.inbox.is_closed()
    }
}

impl Drop for Subscription {
    fn drop(&mut self) {
        let mut subscriptions = lock(&self.graph.subscriptions);
        subscriptions.retain(|other| !Arc::ptr_eq(other, &self.subscribed));
        let others = subscriptions.iter().any(|other| other.topic == self.subscribed.topic);
        drop(subscriptions);
        self.subscribed.close();
        if !others {
            self.graph.unregister(
                "unregisterSubscriber",
                &[self.topic().into(), self.graph.api_uri.as_str().into()],
            );
        }
    }
}

impl fmt::Debug for Subscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Subscription").field(&self.topic()).finish()
    }
}

/// A function that is called with every message of a topic, until this goes. A call that runs then is not
/// waited for.
#[derive(Debug)]
pub struct Listener {
    subscription: Subscription,
}

impl Listener {
    /// The subscription, for its counts.
    pub fn subscription(&self) -> &Subscription {
        &self.subscription
    }
}
