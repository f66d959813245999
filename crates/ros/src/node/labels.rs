//! Publication of class names as `vision_msgs/LabelInfo`.

use std::sync::Arc;
use std::time::{Duration, Instant};

use opendr_engine::target::Classes;
use opendr_engine::{ErrorKind, Header, Result};
use opendr_messages::{MessageType, vision_msgs};
use opendr_ros_bridge::label_info;

use crate::{Graph, Publisher, Qos};

/// A latched message that is also sent again to new subscribers, since RustDDS keeps no message for late ones.
pub(super) struct Labels {
    publisher: Arc<dyn Publisher>,
    info: vision_msgs::LabelInfo,
    listeners: usize,
    /// Time of one repetition, for subscribers that discover the node late.
    again: Option<Instant>,
}

const SECOND_TIME: Duration = Duration::from_secs(1);

impl Labels {
    /// Advertises the topic, if there are class names and this version of ROS has the message.
    pub(super) fn new(graph: &mut dyn Graph, classes: &Classes) -> Result<Option<Self>> {
        if classes.is_empty() {
            return Ok(None);
        }
        let info = label_info(classes, &Header::default(), 0.0)?;
        match graph.advertise("~/label_info", MessageType::VisionMsgsLabelInfo, Qos::LATCHED) {
            Ok(publisher) => {
                publisher.publish(info.clone().into())?;
                Ok(Some(Self { publisher, info, listeners: 0, again: None }))
            }
            // ROS 1 does not have the message.
            Err(error) if error.kind() == ErrorKind::Unsupported => Ok(None),
            Err(error) => Err(error),
        }
    }

    pub(super) fn tick(&mut self) -> Result<()> {
        let listeners = self.publisher.subscribers();
        let new = listeners > self.listeners;
        self.listeners = listeners;
        let due = self.again.is_some_and(|again| Instant::now() >= again);
        if new || due {
            self.again = new.then(|| Instant::now() + SECOND_TIME);
            self.publisher.publish(self.info.clone().into())?;
        }
        Ok(())
    }
}
