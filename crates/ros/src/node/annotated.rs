//! The picture with what was found in it.

use std::sync::Arc;

use opendr_engine::learner::{Entry, Outputs};
use opendr_engine::{Result, Value, ValueType};
use opendr_messages::MessageType;
use opendr_ros_bridge::RosBridge;
use opendr_vision::draw::{Style, draw};

use super::inbox::Set;
use crate::{Graph, Publisher, Qos};

/// Compressed, since DDS loses most of large messages between two machines' default settings; raw for who asks for it.
pub(super) struct Annotated {
    port: usize,
    compressed: Arc<dyn Publisher>,
    raw: Arc<dyn Publisher>,
}

/// Who draws does not want to wait for who looks.
const QOS: Qos = Qos { reliable: true, latched: false, depth: 1 };

impl Annotated {
    /// The topics of a learner that takes a picture and finds something that can be drawn.
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

    /// Draws and sends, where somebody looks.
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
