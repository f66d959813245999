//! Publication of a learner's outputs.

use std::sync::Arc;

use opendr_engine::learner::Outputs;
use opendr_engine::{Result, Value};
use opendr_messages::{Message, MessageType};
use opendr_ros_bridge::{RosBridge, view_action};

use super::path::Paths;
use super::topics::TopicOptions;
use crate::{Graph, Publisher, Qos};

/// Topic of one output.
struct OutputTopic {
    name: String,
    message_type: MessageType,
    publisher: Arc<dyn Publisher>,
}

/// Topics of a node's outputs.
pub(super) struct OutputTopics {
    topics: Vec<OutputTopic>,
    paths: Paths,
    view_action: Arc<dyn Publisher>,
}

impl OutputTopics {
    pub(super) fn new(graph: &mut dyn Graph, topics: &[TopicOptions]) -> Result<Self> {
        let mut own = Vec::with_capacity(topics.len());
        let mut paths = Paths::default();
        for TopicOptions { name, topic, message_type, qos } in topics {
            let publisher = graph.advertise(topic, *message_type, *qos)?;
            if *message_type == MessageType::NavMsgsOdometry {
                paths.add(graph)?;
            }
            own.push(OutputTopic { name: name.clone(), message_type: *message_type, publisher });
        }
        let view_action =
            graph.advertise("~/set_view_action", MessageType::OpendrMsgsViewAction, Qos::RESULT)?;
        Ok(Self { topics: own, paths, view_action })
    }

    /// Publishes every output that has a topic.
    pub(super) fn publish(&mut self, outputs: &Outputs, bridge: &RosBridge) -> Result<()> {
        for topic in &self.topics {
            let Some(value) = outputs.get(&topic.name) else { continue };
            let message = bridge.message_from_value(value.as_value_ref(), topic.message_type)?;
            if let Message::NavMsgsOdometry(odometry) = &message {
                self.paths.publish(odometry)?;
            }
            topic.publisher.publish(message)?;
        }
        for (_, value) in outputs.iter() {
            if let Some(action) = value.as_value_ref().action() {
                self.view_action.publish(view_action(action, value.header())?.into())?;
            }
        }
        Ok(())
    }

    /// Begins new paths, as the stream does.
    pub(super) fn reset(&mut self) {
        self.paths.reset();
    }

    /// Returns whether the node commands velocities, which it must set to zero when inputs stop.
    pub(super) fn command_velocity(&self) -> bool {
        self.velocities().next().is_some()
    }

    /// Commands all velocities to zero.
    pub(super) fn stop(&self, now_ns: i64) -> Result<()> {
        for topic in self.velocities() {
            let mut still = opendr_engine::target::RlTarget::from(vec![0.0; 6]);
            still.header.stamp_ns = Some(now_ns);
            let still = Value::from(still);
            let message: Message =
                RosBridge::default().message_from_value(still.as_value_ref(), topic.message_type)?;
            topic.publisher.publish(message)?;
        }
        Ok(())
    }

    fn velocities(&self) -> impl Iterator<Item = &OutputTopic> {
        let moves = |message| {
            matches!(message, MessageType::GeometryMsgsTwist | MessageType::GeometryMsgsTwistStamped)
        };
        self.topics.iter().filter(move |topic| moves(topic.message_type))
    }
}
