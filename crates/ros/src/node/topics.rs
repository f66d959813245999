//! Which topics a node has: from the tables of its learner.

use opendr_engine::learner::Entry;
use opendr_engine::{Error, Result, ValueType};
use opendr_messages::MessageType;
use opendr_ros_bridge::message_types;

use super::inbox::is_streamed;
use crate::{NodeParams, Qos};

/// A topic for a port or an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TopicOptions {
    /// The port or output.
    pub name: String,
    /// The topic: `/absolute`, `relative` to the namespace or `~/private` to the node.
    pub topic: String,
    /// The message.
    pub message_type: MessageType,
    /// Quality of service.
    pub qos: Qos,
}

/// What a node subscribes to, publishes, and how it behaves.
#[derive(Debug, Clone, Default)]
pub struct NodeOptions {
    /// A topic for each port; a port without one gets nothing.
    pub inputs: Vec<TopicOptions>,
    /// A topic for each output; an output without one is not sent.
    pub outputs: Vec<TopicOptions>,
    /// The node's own parameters.
    pub params: NodeParams,
}

/// The usual topics of a learner: `image_raw` for its picture, the port's name for other inputs, `~/OUTPUT` for what it
/// answers.
pub fn default_topics(entry: &Entry) -> NodeOptions {
    let usual = |name: &'static str, value_type, topic: String, qos| {
        let message_type = message_types(value_type).next()?;
        Some(TopicOptions { name: name.to_owned(), topic, message_type, qos })
    };
    let inputs = entry.ports.iter().filter_map(|port| {
        let topic = if port.value_type == ValueType::Image {
            format!("{}_raw", port.name)
        } else {
            port.name.to_owned()
        };
        let qos = if is_streamed(port.value_type) || port.init {
            Qos { depth: 100, ..Qos::RESULT }
        } else {
            Qos::SENSOR
        };
        usual(port.name, port.value_type, topic, qos)
    });
    let outputs = entry.outputs.iter().filter_map(|output| {
        usual(output.name, output.value_type, format!("~/{}", output.name), Qos::RESULT)
    });
    NodeOptions { inputs: inputs.collect(), outputs: outputs.collect(), params: NodeParams::default() }
}

impl NodeOptions {
    pub(super) fn check(&self, entry: &Entry) -> Result<()> {
        let check = |topic: &TopicOptions, value_type: ValueType| {
            if message_types(value_type).any(|known| known == topic.message_type) {
                return Ok(());
            }
            let known: Vec<_> = message_types(value_type).map(MessageType::ros2_name).collect();
            Err(Error::invalid_input(format!(
                "{} is no message for {} ({}); there are {}",
                topic.message_type.ros2_name(),
                topic.name,
                value_type.name(),
                known.join(", ")
            )))
        };
        for topic in &self.inputs {
            let port = entry.ports.iter().find(|port| port.name == topic.name);
            check(topic, port.ok_or_else(|| unknown("input", topic))?.value_type)?;
        }
        for topic in &self.outputs {
            let output = entry.outputs.iter().find(|output| output.name == topic.name);
            check(topic, output.ok_or_else(|| unknown("output", topic))?.value_type)?;
        }
        let given = |name: &str| self.inputs.iter().any(|topic| topic.name == name);
        match entry.ports.iter().find(|port| !port.optional && !given(port.name)) {
            Some(port) => Err(Error::invalid_input(format!("the input {} needs a topic", port.name))),
            None => Ok(()),
        }
    }
}

#[cold]
fn unknown(what: &str, topic: &TopicOptions) -> Error {
    Error::invalid_input(format!("the learner has no {what} {:?}", topic.name))
}
