//! Table of convertible types, and conversion between types known at run time.

use opendr_engine::{Datum, Error, Result, Value, ValueRef, ValueType};
use opendr_messages::{Message, MessageType, RosMessage};

use crate::ClassIds;

/// A data or target type that converts to and from the message type `M`.
pub trait FromToMessage<M>: Sized {
    /// Reads the message.
    ///
    /// # Errors
    /// `Format` for an inconsistent message; `Unsupported` for an encoding that OpenDR does not read.
    fn from_message(message: M, bridge: &RosBridge) -> Result<Self>;

    /// Writes the message.
    ///
    /// # Errors
    /// `InvalidInput` for a value that the message cannot hold.
    fn to_message(&self, bridge: &RosBridge) -> Result<M>;
}

/// Converter between values and messages, with its options: OpenDR's `ROSBridge`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RosBridge {
    /// Form of `class_id` fields.
    pub class_ids: ClassIds,
    /// JPEG quality of compressed images, 1 (smallest) to 100 (best).
    pub jpeg_quality: u8,
}

impl Default for RosBridge {
    /// Returns a bridge with classes by name and JPEG quality 90.
    fn default() -> Self {
        Self { class_ids: ClassIds::Names, jpeg_quality: 90 }
    }
}

impl RosBridge {
    /// Reads a message of a type known at compile time.
    ///
    /// # Errors
    /// As [`FromToMessage::from_message`].
    pub fn from_message<T: FromToMessage<M>, M>(&self, message: M) -> Result<T> {
        T::from_message(message, self)
    }

    /// Writes a message of a type known at compile time.
    ///
    /// # Errors
    /// As [`FromToMessage::to_message`].
    pub fn to_message<T: FromToMessage<M>, M>(&self, value: &T) -> Result<M> {
        value.to_message(self)
    }

    /// Reads a message as a value of `value_type`.
    ///
    /// # Errors
    /// As [`FromToMessage::from_message`]; `InvalidInput` when the types do not convert.
    pub fn value_from_message(&self, value_type: ValueType, message: Message) -> Result<Value> {
        let message_type = message.message_type();
        (find(value_type, message_type)?.read)(message, self)
    }

    /// Writes a value as a message of `message_type`.
    ///
    /// # Errors
    /// As [`FromToMessage::to_message`]; `InvalidInput` when the types do not convert.
    pub fn message_from_value(&self, value: ValueRef<'_>, message_type: MessageType) -> Result<Message> {
        (find(value.value_type(), message_type)?.write)(value, self)
    }
}

/// Returns the message types that convert to a type; the first is the default.
pub fn message_types(value_type: ValueType) -> impl Iterator<Item = MessageType> {
    PAIRS.iter().filter(move |pair| pair.value_type == value_type).map(|pair| pair.message_type)
}

struct Pair {
    value_type: ValueType,
    message_type: MessageType,
    read: fn(Message, &RosBridge) -> Result<Value>,
    write: fn(ValueRef<'_>, &RosBridge) -> Result<Message>,
}

fn find(value_type: ValueType, message_type: MessageType) -> Result<&'static Pair> {
    let found = PAIRS.iter().find(|pair| pair.value_type == value_type && pair.message_type == message_type);
    found.ok_or_else(|| {
        let known: Vec<_> = message_types(value_type).map(MessageType::ros2_name).collect();
        Error::invalid_input(format!(
            "{} is not a message of {}; there are {}",
            message_type.ros2_name(),
            value_type.name(),
            known.join(", ")
        ))
    })
}

fn read<T, M>(message: Message, bridge: &RosBridge) -> Result<Value>
where
    T: FromToMessage<M> + Into<Value>,
    M: TryFrom<Message, Error = Error>,
{
    T::from_message(message.try_into()?, bridge).map(Into::into)
}

fn write<T, M>(value: ValueRef<'_>, bridge: &RosBridge) -> Result<Message>
where
    T: FromToMessage<M> + Datum,
    M: Into<Message>,
{
    let value = T::from_value_ref(value).ok_or_else(|| {
        Error::internal(format!("a {} where another type is expected", value.value_type().name()))
    })?;
    value.to_message(bridge).map(Into::into)
}

macro_rules! pairs {
    ($($value:ident($module:ident): $($package:ident::$message:ident),+;)*) => {
        const PAIRS: &[Pair] = &[$($(Pair {
            value_type: ValueType::$value,
            message_type: <opendr_messages::$package::$message as RosMessage>::TYPE,
            read: read::<opendr_engine::$module::$value, opendr_messages::$package::$message>,
            write: write::<opendr_engine::$module::$value, opendr_messages::$package::$message>,
        },)+)*];
    };
}

pairs! {
    Image(data): sensor_msgs::Image, sensor_msgs::CompressedImage;
    ImageWithDetections(data): opendr_msgs::ImageWithDetections;
    Video(data): opendr_msgs::Float32MultiArrayStamped;
    PointCloud(data): sensor_msgs::PointCloud2;
    PointCloudWithCalibration(data): opendr_msgs::PointCloudWithCalibration;
    Calibration(data): opendr_msgs::Calibration, sensor_msgs::CameraInfo;
    Timeseries(data): opendr_msgs::Float32MultiArrayStamped, std_msgs::Float32MultiArray;
    Vector(data): opendr_msgs::Float32MultiArrayStamped, std_msgs::Float32MultiArray;
    Audio(data): opendr_msgs::AudioStamped;
    SkeletonSequence(data): opendr_msgs::Float32MultiArrayStamped;
    Observation(data): opendr_msgs::Observation, opendr_msgs::Float32MultiArrayStamped, std_msgs::Float32MultiArray;
    BoundingBoxList(target): vision_msgs::Detection2DArray;
    TrackingAnnotationList(target): vision_msgs::Detection2DArray;
    BoundingBox3DList(target): vision_msgs::Detection3DArray;
    TrackingAnnotation3DList(target): vision_msgs::Detection3DArray;
    PoseList(target): opendr_msgs::Pose2DArray;
    Category(target): vision_msgs::Classification;
    Heatmap(target): sensor_msgs::Image;
    Odometry(target): nav_msgs::Odometry;
    TextRegionList(target): opendr_msgs::TextRegionArray;
    SpeechCommand(target): vision_msgs::Classification;
    BaseTranscription(target): opendr_msgs::Transcription;
    WhisperTranscription(target): opendr_msgs::Transcription;
    VoskTranscription(target): opendr_msgs::Transcription;
    RlTarget(target): opendr_msgs::Float32MultiArrayStamped, geometry_msgs::TwistStamped, geometry_msgs::Twist;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_has_a_message() {
        for value_type in ValueType::ALL {
            assert!(message_types(*value_type).next().is_some(), "{}", value_type.name());
        }
    }

    #[test]
    fn a_message_of_another_type_is_refused() {
        let message = opendr_messages::std_msgs::String::default().into();
        let error =
            RosBridge::default().value_from_message(ValueType::Image, message).unwrap_err().to_string();
        assert!(
            error.contains("std_msgs/msg/String is not a message of Image; there are sensor_msgs/msg/Image"),
            "{error}"
        );
    }
}
