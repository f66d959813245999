//! Macros of the generated tables of messages and services.

/// Generates the enums over all messages and the implementations of each.
macro_rules! messages {
    ($($variant:ident($package:ident::$name:ident) = $package_text:literal, $name_text:literal $($header:ident)? {
        ros2: $hash:literal, $text:literal, [$($uses:literal),*];
        $(ros1: $kind:ident($($own:path)?) $ros1_name:literal, $md5:literal, $ros1_text:literal, [$($ros1_uses:literal),*];)?
    })*) => {
        /// Message types.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum MessageType { $(#[doc = concat!("[`", $package_text, "::", $name_text, "`](", stringify!($package), "::", stringify!($name), ")")] $variant,)* }

        impl MessageType {
            /// All types.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Returns package and name, such as `"sensor_msgs"` and `"Image"`.
            pub const fn package_and_name(self) -> (&'static str, &'static str) {
                match self { $(Self::$variant => ($package_text, $name_text),)* }
            }

            /// Returns the name in ROS 2, such as `"sensor_msgs/msg/Image"`.
            pub const fn ros2_name(self) -> &'static str {
                match self { $(Self::$variant => concat!($package_text, "/msg/", $name_text),)* }
            }

            /// Returns ROS 2's hash of the type (REP 2016), `RIHS01_` and 64 digits.
            pub const fn rihs01(self) -> &'static str {
                match self { $(Self::$variant => $hash,)* }
            }

            /// Returns the type in ROS 1; `None` when ROS 1 does not have it.
            pub const fn ros1(self) -> Option<crate::Ros1Type> {
                match self { $(Self::$variant => messages!(@ros1_type $($ros1_name, $md5, $ros1_text, [$($ros1_uses),*])?),)* }
            }

            pub(crate) const fn ros2_text(self) -> (&'static str, &'static [&'static str]) {
                match self { $(Self::$variant => ($text, &[$($uses),*]),)* }
            }
        }

        /// A message of any type.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        // Only a few values exist at a time, and they are rarely moved.
        #[allow(missing_docs, clippy::large_enum_variant)]
        pub enum Message { $($variant($package::$name),)* }

        impl Message {
            /// Returns the type of the message.
            pub const fn message_type(&self) -> MessageType {
                match self { $(Self::$variant(_) => MessageType::$variant,)* }
            }

            /// Returns the header of a message that has one.
            pub fn header(&self) -> Option<&std_msgs::Header> {
                match self { $(messages!(@pattern $variant message $($header)?) => messages!(@header message $($header)?),)* }
            }

            /// Returns the mutable header of a message that has one.
            pub fn header_mut(&mut self) -> Option<&mut std_msgs::Header> {
                match self { $(messages!(@pattern $variant message $($header)?) => messages!(@header_mut message $($header)?),)* }
            }

            pub(crate) fn to_ros1(&self) -> opendr_engine::Result<Vec<u8>> {
                match self { $(Self::$variant(message) => crate::RosMessage::to_ros1(message),)* }
            }

            pub(crate) fn from_ros1(message_type: MessageType, bytes: &[u8]) -> opendr_engine::Result<Self> {
                match message_type { $(MessageType::$variant => crate::RosMessage::from_ros1(bytes).map(Self::$variant),)* }
            }
        }

        /// Serialised as the message itself.
        impl serde::Serialize for Message {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self { $(Self::$variant(message) => message.serialize(serializer),)* }
            }
        }

        /// Reads a message of the type.
        impl<'de> serde::de::DeserializeSeed<'de> for MessageType {
            type Value = Message;

            fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<Message, D::Error> {
                match self { $(Self::$variant => serde::Deserialize::deserialize(deserializer).map(Message::$variant),)* }
            }
        }

        $(
            impl From<$package::$name> for Message {
                fn from(message: $package::$name) -> Self {
                    Self::$variant(message)
                }
            }

            impl TryFrom<Message> for $package::$name {
                type Error = opendr_engine::Error;

                fn try_from(message: Message) -> opendr_engine::Result<Self> {
                    match message {
                        Message::$variant(message) => Ok(message),
                        other => Err(crate::message_type::wrong_type(other.message_type(), MessageType::$variant)),
                    }
                }
            }

            impl crate::RosMessage for $package::$name {
                const TYPE: MessageType = MessageType::$variant;

                messages!(@ros1_bytes $($kind($($own)?))?);
            }
        )*
    };
    (@pattern $variant:ident $message:ident header) => { Self::$variant($message) };
    (@pattern $variant:ident $message:ident) => { Self::$variant(_) };
    (@header $message:ident header) => { Some(&$message.header) };
    (@header $message:ident) => { None };
    (@header_mut $message:ident header) => { Some(&mut $message.header) };
    (@header_mut $message:ident) => { None };
    (@ros1_type) => { None };
    (@ros1_type $name:literal, $md5:literal, $text:literal, [$($uses:literal),*]) => {
        Some(crate::Ros1Type { name: $name, md5sum: $md5, text: $text, uses: &[$($uses),*] })
    };
    (@ros1_bytes) => {
        fn to_ros1(&self) -> opendr_engine::Result<Vec<u8>> {
            Err(crate::message_type::not_in_ros1(Self::TYPE))
        }

        fn from_ros1(_: &[u8]) -> opendr_engine::Result<Self> {
            Err(crate::message_type::not_in_ros1(Self::TYPE))
        }
    };
    (@ros1_bytes same()) => {
        fn to_ros1(&self) -> opendr_engine::Result<Vec<u8>> {
            crate::ros1_from_message(self)
        }

        fn from_ros1(bytes: &[u8]) -> opendr_engine::Result<Self> {
            crate::message_from_ros1(bytes)
        }
    };
    (@ros1_bytes own($form:path)) => {
        fn to_ros1(&self) -> opendr_engine::Result<Vec<u8>> {
            crate::ros1_from_message(&<$form>::from(self))
        }

        fn from_ros1(bytes: &[u8]) -> opendr_engine::Result<Self> {
            crate::message_from_ros1::<$form>(bytes).map(Self::from)
        }
    };
}

/// Generates a marker type for each service, with its names and hashes.
macro_rules! services {
    ($($variant:ident($request:path, $response:path) = $package:literal, $name:literal, $md5:literal, $hash:literal;)*) => {
        /// All services.
        pub const SERVICE_TYPES: &[crate::ServiceType] = &[$(<$variant as crate::RosService>::TYPE,)*];

        $(
        #[doc = concat!("`", $package, "/", $name, "`.")]
        #[derive(Debug, Clone, Copy)]
        pub struct $variant;

        impl crate::RosService for $variant {
            type Request = $request;
            type Response = $response;
            const TYPE: crate::ServiceType =
                crate::ServiceType { package: $package, name: $name, md5sum: $md5, rihs01: $hash };
        }
    )*};
}
