//! Stamps and frame ids.

use opendr_engine::{Error, Header, Result};
use opendr_messages::{builtin_interfaces, std_msgs};

const NANOSECONDS_A_SECOND: i64 = 1_000_000_000;

/// Returns a time in nanoseconds since the epoch of its clock.
pub fn nanoseconds(time: &builtin_interfaces::Time) -> i64 {
    i64::from(time.sec) * NANOSECONDS_A_SECOND + i64::from(time.nanosec)
}

/// Returns the message of a time in nanoseconds.
///
/// # Errors
/// `InvalidInput` for a time that does not fit the 32-bit seconds of ROS (after 2038).
pub fn time(nanoseconds: i64) -> Result<builtin_interfaces::Time> {
    let (sec, nanosec) =
        (nanoseconds.div_euclid(NANOSECONDS_A_SECOND), nanoseconds.rem_euclid(NANOSECONDS_A_SECOND));
    match (i32::try_from(sec), u32::try_from(nanosec)) {
        (Ok(sec), Ok(nanosec)) => Ok(builtin_interfaces::Time { sec, nanosec }),
        _ => Err(Error::invalid_input(format!(
            "the stamp {nanoseconds} ns does not fit the 32-bit seconds of ROS; give nanoseconds since 1970"
        ))),
    }
}

/// Returns the header of a message; a stamp of 0 and an empty frame id mean unknown, as in ROS.
pub fn header_from_message(header: &std_msgs::Header) -> Header {
    let stamp = nanoseconds(&header.stamp);
    Header {
        stamp_ns: (stamp != 0).then_some(stamp),
        frame_id: (!header.frame_id.is_empty()).then(|| header.frame_id.as_str().into()),
    }
}

/// Returns the message of a header.
///
/// # Errors
/// As [`time`].
pub fn message_from_header(header: &Header) -> Result<std_msgs::Header> {
    Ok(std_msgs::Header {
        stamp: time(header.stamp_ns.unwrap_or(0))?,
        frame_id: header.frame_id.as_deref().unwrap_or_default().to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways() {
        for header in [Header::default(), Header::new(1_700_000_000_123_456_789, "map"), Header::new(-1, "")]
        {
            let back = header_from_message(&message_from_header(&header).unwrap());
            assert_eq!(back.stamp_ns, header.stamp_ns);
            assert_eq!(back.frame_id.unwrap_or_default(), header.frame_id.unwrap_or_default());
        }
    }

    #[test]
    fn times_that_do_not_fit_are_refused() {
        let error = time(i64::MAX).unwrap_err().to_string();
        assert!(error.contains("9223372036854775807"), "{error}");
        let odd = builtin_interfaces::Time { sec: i32::MIN, nanosec: u32::MAX };
        assert_eq!(nanoseconds(&odd), -2_147_483_648_000_000_000 + 4_294_967_295);
    }
}
