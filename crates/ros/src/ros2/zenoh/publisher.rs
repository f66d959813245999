//! Publishers over Zenoh.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use opendr_engine::Result;
use opendr_messages::{Message, WireFormat};
use zenoh::Wait;

use super::attachment::Attachment;
use super::listeners::Listeners;
use crate::Publisher;
use crate::clock::system_time_ns;
use crate::ros2::error::network_error;

pub(super) struct ZenohPublisher {
    pub publisher: zenoh::pubsub::Publisher<'static>,
    pub topic: String,
    pub gid: [u8; 16],
    pub sent: AtomicI64,
    pub listeners: Arc<Listeners>,
}

impl Publisher for ZenohPublisher {
    fn publish(&self, message: Message) -> Result<()> {
        let attachment = Attachment {
            // rclcpp counts from 1.
            sequence_number: self.sent.fetch_add(1, Ordering::Relaxed) + 1,
            source_timestamp: system_time_ns(),
            source_gid: self.gid,
        };
        self.publisher
            .put(message.to_bytes(WireFormat::Cdr)?)
            .attachment(attachment.to_bytes())
            .wait()
            .map_err(|error| network_error("sending", &error))
    }

    fn subscribers(&self) -> usize {
        self.listeners.count(&self.topic)
    }
}
