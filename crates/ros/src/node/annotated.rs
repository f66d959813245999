//! Publication of annotated images.

use std::sync::Arc;

use opendr_engine::learner::{Entry, Outputs};
use opendr_engine::{Result, Value, ValueType};
use opendr_messages::MessageType;
use opendr_ros_bridge::RosBridge;
use opendr_vision::draw::{Style, draw};

use super::inbox::Set;
use crate::{Graph, Publisher, Qos};

/// Topics of annotated images: compressed, since DDS with default settings loses most large messages between machines, and raw.
pub(super) struct Annotated {
    port: usize,
    compressed: Arc<dyn Publisher>,
    raw: Arc<dyn Publisher>,
}

/// Quality of service with a queue of one, so that the node never waits for a viewer.
const QOS: Qos = Qos { reliable: true, latched: false, depth: 1 };

impl Annotated {
    /// Advertises the topics for a learner with an image input and an output that can be drawn.
    pub(super) fn new(graph: &mut dyn Graph, entry: &Entry) -> Result<Option<Self>> {
        let drawn = |value_type| {
            matches!(
                value_type,
                ValueType::BoundingBoxList
                    | ValueType::TrackingAnnotationList
                    | ValueType::PoseList
                    | ValueType::Category
                    | ValueType::Heatmap
            )
        };
        let port = entry.ports.iter().position(|port| port.value_type == ValueType::Image);
        let Some(port) = port.filter(|_| entry.outputs.iter().any(|output| drawn(output.value_type))) else {
            return Ok(None);
        };
        let compressed =
            graph.advertise("~/annotated/compressed", MessageType::SensorMsgsCompressedImage, QOS)?;
        let raw = graph.advertise("~/annotated", MessageType::SensorMsgsImage, QOS)?;
        Ok(Some(Self { port, compressed, raw }))
    }

    /// Draws and publishes the image, if there are subscribers.
    pub(super) fn publish(&self, set: &Set, outputs: &Outputs, bridge: &RosBridge) -> Result<()> {
        let listened = [&self.compressed, &self.raw].map(|publisher| publisher.subscribers() > 0);
        let Some(Some(frame)) = set.get(self.port) else { return Ok(()) };
        let (true, Value::Image(image)) = (listened.contains(&true), frame.value()?) else { return Ok(()) };
        let mut image = image.clone();
        for (_, output) in outputs.iter() {
            draw(&mut image, output.as_value_ref(), &Style::default());
        }
        let image = Value::from(image);
        for (publisher, message_type) in [
            (&self.compressed, MessageType::SensorMsgsCompressedImage),
            (&self.raw, MessageType::SensorMsgsImage),
        ] {
            if publisher.subscribers() > 0 {
                publisher.publish(bridge.message_from_value(image.as_value_ref(), message_type)?)?;
            }
        }
        Ok(())
    }
}
