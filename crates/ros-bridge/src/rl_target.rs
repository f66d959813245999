//! Actions of policies: an array, or a velocity.

use opendr_engine::target::RlTarget;
use opendr_engine::{Error, Result};
use opendr_messages::geometry_msgs::{Twist, TwistStamped, Vector3};
use opendr_messages::opendr_msgs::Float32MultiArrayStamped;

use crate::array::{array_from_message, message_from_array};
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// The numbers of the action.
impl FromToMessage<Float32MultiArrayStamped> for RlTarget {
    fn from_message(message: Float32MultiArrayStamped, _: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        Ok(Self { header, ..Self::from(array_from_message(message.array)?.1) })
    }

    fn to_message(&self, _: &RosBridge) -> Result<Float32MultiArrayStamped> {
        let array = message_from_array(&[self.values.len()], &["action"], &self.values)?;
        Ok(Float32MultiArrayStamped { header: message_from_header(&self.header)?, array })
    }
}

/// A velocity in m/s and rad/s. Written from 2 numbers (forward, yaw rate), 3 (forward, left, up), 4 (forward, left, up, yaw rate)
/// or 6 (linear x, y, z, angular x, y, z); read as 6.
impl FromToMessage<Twist> for RlTarget {
    fn from_message(message: Twist, _: &RosBridge) -> Result<Self> {
        let Twist { linear, angular } = message;
        let values = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z];
        Ok(Self::from(values.map(|value| value as f32).to_vec()))
    }

    fn to_message(&self, _: &RosBridge) -> Result<Twist> {
        let linear = |x: f32, y: f32, z: f32| Vector3 { x: x.into(), y: y.into(), z: z.into() };
        let (linear, angular) = match self.values[..] {
            [ahead, turn] => (linear(ahead, 0.0, 0.0), linear(0.0, 0.0, turn)),
            [ahead, left, up] => (linear(ahead, left, up), Vector3::default()),
            [ahead, left, up, turn] => (linear(ahead, left, up), linear(0.0, 0.0, turn)),
            [x, y, z, about_x, about_y, about_z] => (linear(x, y, z), linear(about_x, about_y, about_z)),
            _ => {
                return Err(Error::invalid_input(format!(
                    "an action of {} numbers is not a velocity, which has 2, 3, 4 or 6",
                    self.values.len()
                )));
            }
        };
        Ok(Twist { linear, angular })
    }
}

/// A velocity with stamp and frame.
impl FromToMessage<TwistStamped> for RlTarget {
    fn from_message(message: TwistStamped, bridge: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        Ok(Self { header, ..bridge.from_message(message.twist)? })
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<TwistStamped> {
        Ok(TwistStamped { header: message_from_header(&self.header)?, twist: bridge.to_message(self)? })
    }
}
