//! ROS 1's message format: little-endian, without padding; strings and arrays follow a 32-bit count.
//!
//! The structs are ROS 2's. The format therefore adds the field that only ROS 1 has (the `seq` of a header, always 0) and omits the
//! one that only ROS 2 has (the dummy field of messages without fields).

mod fields;
mod reader;
mod reason;
mod writer;

use opendr_engine::{Error, Result};
use serde::Serialize;
use serde::de::DeserializeOwned;

use reader::Reader;
use reason::Reason;
use writer::Writer;

/// Writes a message in ROS 1's format, without the length prefix of TCPROS.
///
/// # Errors
/// `InvalidInput` for more than 2^32 - 1 elements.
pub fn ros1_from_message(message: &impl Serialize) -> Result<Vec<u8>> {
    let mut writer = Writer::default();
    message.serialize(&mut writer).map_err(|reason| Error::invalid_input(reason.to_string()))?;
    Ok(writer.into_bytes())
}

/// Reads a message in ROS 1's format.
///
/// # Errors
/// `Format` for incomplete or surplus bytes, a length beyond the end, or text that is not UTF-8.
pub fn message_from_ros1<M: DeserializeOwned>(bytes: &[u8]) -> Result<M> {
    let unreadable = |reason: Reason| {
        Error::format(format!(
            "{} bytes cannot be read as {} of ROS 1: {reason}",
            bytes.len(),
            std::any::type_name::<M>()
        ))
    };
    let mut reader = Reader::new(bytes);
    let message = M::deserialize(&mut reader).map_err(unreadable)?;
    reader.end().map_err(unreadable)?;
    Ok(message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{builtin_interfaces, sensor_msgs, std_msgs};

    #[test]
    fn header_equals_that_of_rospy() {
        let header = std_msgs::Header {
            stamp: builtin_interfaces::Time { sec: 1, nanosec: 2 },
            frame_id: "ab".to_owned(),
        };
        let bytes = ros1_from_message(&header).unwrap();
        assert_eq!(bytes, [0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, b'a', b'b']);
        let mut numbered = bytes.clone();
        numbered[0] = 9;
        assert_eq!(message_from_ros1::<std_msgs::Header>(&numbered).unwrap(), header);
    }

    #[test]
    fn nothing_is_nothing() {
        assert!(ros1_from_message(&std_msgs::Empty::default()).unwrap().is_empty());
        message_from_ros1::<std_msgs::Empty>(&[]).unwrap();
    }

    #[test]
    fn lengths_are_checked() {
        let image = sensor_msgs::Image { data: vec![7; 5], encoding: "mono8".into(), ..Default::default() };
        let bytes = ros1_from_message(&image).unwrap();
        assert_eq!(message_from_ros1::<sensor_msgs::Image>(&bytes).unwrap(), image);
        for end in 0..bytes.len() {
            assert!(message_from_ros1::<sensor_msgs::Image>(&bytes[..end]).is_err(), "{end}");
        }
        let mut longer = bytes.clone();
        longer.push(0);
        let error = message_from_ros1::<sensor_msgs::Image>(&longer).unwrap_err().to_string();
        assert!(error.contains("1 bytes are left over"), "{error}");
        // A length field of 4 GB.
        let at = bytes.len() - 9;
        longer[at..at + 4].fill(0xff);
        assert!(message_from_ros1::<sensor_msgs::Image>(&longer).is_err());
        let text = message_from_ros1::<std_msgs::String>(&[1, 0, 0, 0, 0xff]).unwrap_err().to_string();
        assert!(text.contains("UTF-8"), "{text}");
    }
}
