//! Topics of a node, from the ports and outputs of its learner.

use opendr_engine::learner::Entry;
use opendr_engine::{Error, Result, ValueType};
use opendr_messages::MessageType;
use opendr_ros_bridge::message_types;

use super::inbox::is_streamed;
use crate::{NodeParams, Qos};

/// Topic of a port or an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TopicOptions {
    /// Name of the port or output.
    pub name: String,
    /// Name of the topic: `/absolute`, `relative` to the namespace or `~/private` to the node.
    pub topic: String,
    /// Message type.
    pub message_type: MessageType,
    /// Quality of service.
    pub qos: Qos,
}

/// Topics and parameters of a node.
#[derive(Debug, Clone, Default)]
pub struct NodeOptions {
    /// Topics of the ports; a port without one gets no input.
    pub inputs: Vec<TopicOptions>,
    /// Topics of the outputs; an output without one is not published.
    pub outputs: Vec<TopicOptions>,
    /// Parameters of the node.
    pub params: NodeParams,
}

/// Returns the default topics of a learner: `image_raw` for its image, the port's name for other inputs, `~/OUTPUT` for its
/// outputs.
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
                "{} is not a message for {} ({}); there are {}",
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
