//! Subscriptions shared by the learners of a process: each message is received and decoded once.

use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::{Result, ValueType};
use opendr_messages::MessageType;

use super::frame::Frame;
use super::inbox::Inbox;
use super::topics::TopicOptions;
use crate::Graph;

type Listeners = Arc<Mutex<Vec<(Arc<Inbox>, usize)>>>;

/// Shared subscriptions of a process, by absolute name, message type and value type.
#[derive(Default)]
pub struct SharedSubscriptions {
    feeds: Vec<((String, MessageType, ValueType), Listeners)>,
}

impl SharedSubscriptions {
    /// Delivers the messages of a topic also to the port `port` of `inbox`.
    pub(super) fn subscribe(
        &mut self,
        graph: &mut dyn Graph,
        topic: &TopicOptions,
        value_type: ValueType,
        inbox: &Arc<Inbox>,
        port: usize,
    ) -> Result<()> {
        let key = (graph.resolve(&topic.topic)?, topic.message_type, value_type);
        let listener = (inbox.clone(), port);
        if let Some((_, listeners)) = self.feeds.iter().find(|(known, _)| *known == key) {
            listeners.lock().unwrap_or_else(PoisonError::into_inner).push(listener);
            return Ok(());
        }
        let listeners: Listeners = Arc::new(Mutex::new(vec![listener]));
        self.feeds.push((key, listeners.clone()));
        let clock = graph.clock();
        graph.subscribe(
            &topic.topic,
            topic.message_type,
            topic.qos,
            Box::new(move |message| {
                let frame = Arc::new(Frame::new(message, value_type, clock()));
                for (inbox, port) in listeners.lock().unwrap_or_else(PoisonError::into_inner).iter() {
                    inbox.put(*port, frame.clone());
                }
            }),
        )
    }
}
