//! Handles of subscribed topics.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

use super::inbox::Inbox;
use super::link::Wanted;
use super::{ReceivedMessage, Subscribed};
use crate::TopicType;
use crate::graph::Graph;
use crate::lock::lock;

/// Options of a subscription.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubscriberOptions {
    /// Maximum number of queued messages; the oldest is dropped. 1 keeps only the newest.
    pub queue_size: usize,
    /// Whether publishers are requested to disable Nagle's algorithm, so that small messages are sent at once.
    pub tcp_nodelay: bool,
}

impl Default for SubscriberOptions {
    fn default() -> Self {
        Self { queue_size: 1, tcp_nodelay: true }
    }
}

/// Subscription to a topic, which ends when it is dropped.
///
/// Messages are received continuously. If they are taken too slowly, the oldest are dropped, and publishers are never blocked.
pub struct Subscription {
    graph: Arc<Graph>,
    subscribed: Arc<Subscribed>,
}

impl Subscription {
    /// Subscribes to the topic with the full name `topic`.
    pub(crate) fn new(
        graph: &Arc<Graph>,
        topic: &str,
        kind: TopicType,
        options: SubscriberOptions,
    ) -> Result<Self> {
        kind.check()?;
        if options.queue_size == 0 {
            return Err(Error::invalid_param(
                "queue_size is 0; give at least 1, which keeps the newest message only",
            ));
        }
        let wanted = Wanted {
            topic: topic.to_owned(),
            kind,
            tcp_nodelay: options.tcp_nodelay,
            inbox: Arc::new(Inbox::new(options.queue_size)),
        };
        let subscribed = Arc::new(Subscribed::new(&graph.context, wanted));
        let mut subscriptions = lock(&graph.subscriptions);
        graph.context.check_running()?;
        subscriptions.push(Arc::clone(&subscribed));
        drop(subscriptions);
        // If the registration fails, dropping `subscription` removes the topic.
        let subscription = Self { graph: Arc::clone(graph), subscribed };
        subscription.subscribed.register(false)?;
        Ok(subscription)
    }

    /// Waits for the next message; returns `None` after the shutdown of the node.
    pub fn recv(&self) -> Option<ReceivedMessage> {
        self.subscribed.wanted.inbox.pop(None)
    }

    /// Waits for the next message, for at most `time`.
    pub fn recv_timeout(&self, time: Duration) -> Option<ReceivedMessage> {
        self.subscribed.wanted.inbox.pop(Instant::now().checked_add(time))
    }

    /// Returns the next message, if there is one.
    pub fn try_recv(&self) -> Option<ReceivedMessage> {
        self.recv_timeout(Duration::ZERO)
    }

    /// Returns the newest message, if there is one, and drops those before it.
    pub fn latest(&self) -> Option<ReceivedMessage> {
        self.subscribed.wanted.inbox.pop_newest()
    }

    /// Calls `take` with every message, on a thread of its own, until the listener is dropped. Messages queue while it runs. A panic
    /// in it is reported to `NodeOptions::on_error`.
    ///
    /// # Errors
    /// `Network` after the shutdown of the node, `Io` when the system has no more threads.
    pub fn on_message(self, mut take: impl FnMut(ReceivedMessage) + Send + 'static) -> Result<Listener> {
        let (graph, subscribed) = (Arc::clone(&self.graph), Arc::clone(&self.subscribed));
        self.graph.context.tasks.spawn("listener", move |_| {
            while let Some(message) = subscribed.wanted.inbox.pop(None) {
                graph.context.guarded("the owner's function for messages", || take(message));
            }
        })?;
        Ok(Listener { subscription: self })
    }

    /// Returns the topic's full name.
    pub fn topic(&self) -> &str {
        &self.subscribed.wanted.topic
    }

    /// Returns the number of connected publishers.
    pub fn publisher_count(&self) -> usize {
        let links = self.subscribed.links();
        links.iter().filter(|link| link.connected.load(Ordering::Relaxed)).count()
    }

    /// Returns the number of messages received from the current publishers.
    pub fn received(&self) -> u64 {
        self.subscribed.links().iter().map(|link| link.received_messages.load(Ordering::Relaxed)).sum()
    }

    /// Returns the number of dropped messages.
    pub fn dropped(&self) -> u64 {
        self.subscribed.wanted.inbox.dropped.load(Ordering::Relaxed)
    }

    /// Returns whether the node is shut down, so that no message follows.
    pub fn is_closed(&self) -> bool {
        self.subscribed.wanted.inbox.is_closed()
    }
}

impl Drop for Subscription {
    fn drop(&mut self) {
        let mut subscriptions = lock(&self.graph.subscriptions);
        subscriptions.retain(|other| !Arc::ptr_eq(other, &self.subscribed));
        let others = subscriptions.iter().any(|other| other.wanted.topic == self.subscribed.wanted.topic);
        drop(subscriptions);
        self.subscribed.close();
        if !others {
            self.graph.context.unregister(
                "unregisterSubscriber",
                &[self.topic().into(), self.graph.context.api_uri.as_str().into()],
            );
        }
    }
}

impl fmt::Debug for Subscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Subscription").field(&self.topic()).finish()
    }
}

/// Handle of a message callback; dropping it ends the calls, without waiting for a running one.
#[derive(Debug)]
pub struct Listener {
    subscription: Subscription,
}

impl Listener {
    /// Returns the subscription, for its counts.
    pub fn subscription(&self) -> &Subscription {
        &self.subscription
    }
}
