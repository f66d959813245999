//! The list of data and target types, and [`Value`], a datum of any of them.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::data::{
    Audio, Calibration, Image, ImageWithDetections, Observation, PointCloud, PointCloudWithCalibration,
    SkeletonSequence, Timeseries, Vector, Video,
};
use crate::target::{
    Action, BaseTranscription, BoundingBox3DList, BoundingBoxList, Category, Heatmap, Odometry, PoseList,
    RlTarget, SpeechCommand, TextRegionList, TrackingAnnotation3DList, TrackingAnnotationList,
    VoskTranscription, WhisperTranscription,
};
use crate::{Error, Header, Result};

/// A data or target type.
pub trait Datum: Clone + Send + Sync + 'static {
    /// The type as a value.
    const TYPE: ValueType;

    /// Returns time stamp and frame id.
    fn header(&self) -> &Header;

    /// Returns time stamp and frame id for modification.
    fn header_mut(&mut self) -> &mut Header;

    /// Returns a type-erased reference to the datum.
    fn as_value_ref(&self) -> ValueRef<'_>;

    /// Returns the datum if it is of this type.
    fn from_value_ref(value: ValueRef<'_>) -> Option<&Self>;
}

macro_rules! values {
    (data { $($data:ident = $data_port:literal),* $(,)? } targets { $($target:ident = $target_port:literal),* $(,)? }) => {
        /// A data or target type, as a value.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum ValueType { $(#[doc = concat!("[`", stringify!($data), "`]")] $data,)* $(#[doc = concat!("[`", stringify!($target), "`]")] $target,)* }

        impl ValueType {
            /// All types.
            pub const ALL: &'static [Self] = &[$(Self::$data,)* $(Self::$target,)*];

            /// Returns the name of the type, e.g. `"BoundingBoxList"`.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$data => stringify!($data),)* $(Self::$target => stringify!($target),)* }
            }

            /// Returns the default name of a port of the type, e.g. `"image"`.
            pub const fn port(self) -> &'static str {
                match self { $(Self::$data => $data_port,)* $(Self::$target => $target_port,)* }
            }

            /// Returns whether the type is a target. Targets have a JSON form, data have none.
            pub const fn is_target(self) -> bool {
                match self { $(Self::$data => false,)* $(Self::$target => true,)* }
            }
        }

        /// Parses the name of a type.
        impl FromStr for ValueType {
            type Err = Error;

            /// # Errors
            /// Returns `NotFound` with the list of types for an unknown name.
            fn from_str(name: &str) -> Result<Self> {
                Self::ALL.iter().copied().find(|known| known.name() == name).ok_or_else(|| {
                    let names: Vec<_> = Self::ALL.iter().map(|known| known.name()).collect();
                    Error::not_found(format!("no type {name:?}; there are {}", names.join(", ")))
                })
            }
        }

        /// A datum or target of any type.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        #[allow(missing_docs)]
        pub enum Value { $($data($data),)* $($target($target),)* }

        /// A borrowed [`Value`].
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[non_exhaustive]
        #[allow(missing_docs)]
        pub enum ValueRef<'a> { $($data(&'a $data),)* $($target(&'a $target),)* }

        impl Value {
            /// Returns a reference to the value.
            pub fn as_value_ref(&self) -> ValueRef<'_> {
                match self { $(Self::$data(value) => ValueRef::$data(value),)* $(Self::$target(value) => ValueRef::$target(value),)* }
            }

            /// Returns time stamp and frame id.
            pub fn header(&self) -> &Header {
                match self { $(Self::$data(value) => value.header(),)* $(Self::$target(value) => value.header(),)* }
            }

            /// Returns time stamp and frame id for modification.
            pub fn header_mut(&mut self) -> &mut Header {
                match self { $(Self::$data(value) => value.header_mut(),)* $(Self::$target(value) => value.header_mut(),)* }
            }
        }

        impl<'a> ValueRef<'a> {
            /// Returns the type of the value.
            pub fn value_type(&self) -> ValueType {
                match self { $(Self::$data(_) => ValueType::$data,)* $(Self::$target(_) => ValueType::$target,)* }
            }

            /// Returns the camera motion that a target proposes for a better view, if any.
            pub fn action(self) -> Option<&'a Action> {
                match self { $(Self::$data(_) => None,)* $(Self::$target(value) => value.action.as_ref(),)* }
            }

            /// Clones the value; large payloads stay shared.
            pub fn to_value(self) -> Value {
                match self { $(Self::$data(value) => Value::$data(value.clone()),)* $(Self::$target(value) => Value::$target(value.clone()),)* }
            }
        }

        /// Writes OpenDR's text; with `{:#}`, a readable line per item.
        impl fmt::Display for ValueRef<'_> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self { $(Self::$data(value) => value.fmt(f),)* $(Self::$target(value) => value.fmt(f),)* }
            }
        }

        values!(@each $($data)* $($target)*);

        /// The JSON form of targets: the fields of the target and its type under `"type"`.
        #[derive(Serialize)]
        #[serde(tag = "type")]
        enum TargetJson<'a> { $($target(&'a $target),)* }

        #[derive(Deserialize)]
        #[serde(tag = "type")]
        enum OwnedTargetJson { $($target($target),)* }

        /// Serialises targets only; data have no JSON form.
        impl Serialize for ValueRef<'_> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self {
                    $(Self::$target(value) => TargetJson::$target(value).serialize(serializer),)*
                    $(Self::$data(_) => {
                        Err(serde::ser::Error::custom(concat!(stringify!($data), " has no JSON form; write it as a file")))
                    })*
                }
            }
        }

        impl<'de> Deserialize<'de> for Value {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                Ok(match OwnedTargetJson::deserialize(deserializer)? {
                    $(OwnedTargetJson::$target(value) => Self::$target(value),)*
                })
            }
        }
    };
    (@each $($name:ident)*) => {$(
        impl Datum for $name {
            const TYPE: ValueType = ValueType::$name;

            fn header(&self) -> &Header {
                &self.header
            }

            fn header_mut(&mut self) -> &mut Header {
                &mut self.header
            }

            fn as_value_ref(&self) -> ValueRef<'_> {
                ValueRef::$name(self)
            }

            fn from_value_ref(value: ValueRef<'_>) -> Option<&Self> {
                match value {
                    ValueRef::$name(value) => Some(value),
                    _ => None,
                }
            }
        }

        impl From<$name> for Value {
            fn from(value: $name) -> Self {
                Self::$name(value)
            }
        }

        impl<'a> From<&'a $name> for ValueRef<'a> {
            fn from(value: &'a $name) -> Self {
                ValueRef::$name(value)
            }
        }
    )*};
}

values! {
    data {
        Image = "image",
        ImageWithDetections = "image_with_detections",
        Video = "video",
        PointCloud = "point_cloud",
        PointCloudWithCalibration = "point_cloud_with_calibration",
        Calibration = "calibration",
        Timeseries = "timeseries",
        Vector = "vector",
        Audio = "audio",
        SkeletonSequence = "skeleton_sequence",
        Observation = "observation",
    }
    targets {
        BoundingBoxList = "boxes",
        TrackingAnnotationList = "tracks",
        BoundingBox3DList = "boxes_3d",
        TrackingAnnotation3DList = "tracks_3d",
        PoseList = "poses",
        Category = "category",
        Heatmap = "heatmap",
        Odometry = "odometry",
        TextRegionList = "texts",
        SpeechCommand = "command",
        BaseTranscription = "transcription",
        WhisperTranscription = "transcription",
        VoskTranscription = "transcription",
        RlTarget = "target",
    }
}

impl<'a> From<&'a Value> for ValueRef<'a> {
    fn from(value: &'a Value) -> Self {
        value.as_value_ref()
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_value_ref().fmt(f)
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.as_value_ref().serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::BoundingBox;

    #[test]
    fn json_round_trip() {
        let mut boxes = BoundingBoxList::from(vec![BoundingBox::new(3, 1.0, 2.0, 3.5, 4.0, 0.9)]);
        boxes.header = Header::new(5, "camera");
        let value = Value::from(boxes);
        let text = serde_json::to_string(&value).unwrap();
        assert_eq!(
            text,
            r#"{"type":"BoundingBoxList","stamp_ns":5,"frame_id":"camera","boxes":[{"name":3,"left":1.0,"top":2.0,"width":3.5,"height":4.0,"confidence":0.9}]}"#
        );
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }

    #[test]
    fn images_have_no_json_form() {
        let image = Image::from_rgb8(vec![0; 3], 1, 1).unwrap();
        assert!(serde_json::to_string(&Value::from(image)).is_err());
    }
}
