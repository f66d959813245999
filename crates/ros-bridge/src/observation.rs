//! Observations: `opendr_msgs/Observation`, or a plain array.

use opendr_engine::data::Observation;
use opendr_engine::{Error, Result};
use opendr_messages::opendr_msgs::{self, Float32MultiArrayStamped, ObservationPart};
use opendr_messages::std_msgs::Float32MultiArray;

use crate::array::{array_from_message, message_from_array};
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Parts by name; an observation without parts is one unnamed part.
impl FromToMessage<opendr_msgs::Observation> for Observation {
    fn from_message(message: opendr_msgs::Observation, _: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        let mut parts = Vec::with_capacity(message.parts.len());
        for part in message.parts {
            let (shape, data) = array_from_message(part.array)?;
            parts.push((part.name, shape, data));
        }
        let observation = match &parts[..] {
            [] => return Err(Error::format("the observation has no parts")),
            [(name, _, data)] if name.is_empty() => Self::from_data(data.clone())?,
            parts => Self::from_parts(
                parts.iter().map(|(name, shape, data)| (name.as_str(), shape.as_slice(), data.as_slice())),
            )?,
        };
        Ok(observation.with_header(header))
    }

    fn to_message(&self, _: &RosBridge) -> Result<opendr_msgs::Observation> {
        let mut parts = Vec::new();
        for (name, shape, numbers) in self.parts() {
            parts.push(ObservationPart {
                name: name.to_owned(),
                array: message_from_array(shape, &[], numbers)?,
            });
        }
        if parts.is_empty() {
            let numbers = self.as_slice();
            parts.push(ObservationPart {
                name: String::new(),
                array: message_from_array(&[numbers.len()], &[], numbers)?,
            });
        }
        Ok(opendr_msgs::Observation { header: message_from_header(&self.header)?, parts })
    }
}

/// The numbers as one row.
impl FromToMessage<Float32MultiArrayStamped> for Observation {
    fn from_message(message: Float32MultiArrayStamped, bridge: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        Ok(<Self as FromToMessage<Float32MultiArray>>::from_message(message.array, bridge)?
            .with_header(header))
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<Float32MultiArrayStamped> {
        let header = message_from_header(&self.header)?;
        Ok(Float32MultiArrayStamped { header, array: self.to_message(bridge)? })
    }
}

/// The numbers as one row, without stamp and frame.
impl FromToMessage<Float32MultiArray> for Observation {
    fn from_message(message: Float32MultiArray, _: &RosBridge) -> Result<Self> {
        Self::from_data(array_from_message(message)?.1)
    }

    fn to_message(&self, _: &RosBridge) -> Result<Float32MultiArray> {
        let numbers = self.as_slice();
        message_from_array(&[numbers.len()], &["numbers"], numbers)
    }
}
