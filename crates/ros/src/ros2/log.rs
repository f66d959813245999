//! Log lines on the terminal and on `/rosout`.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_messages::{MessageType, rcl_interfaces};
use opendr_ros_bridge::time;

use crate::clock::system_time_ns;
use crate::{Graph, Log, Qos, Severity};

/// Quality of service of `/rosout` in rclcpp.
const QOS: Qos = Qos { reliable: true, latched: true, depth: 1000 };

pub(super) fn start(node: &mut impl Graph) -> Result<Log> {
    let publisher = node.advertise("/rosout", MessageType::RclInterfacesLog, QOS)?;
    let name = node.name().trim_start_matches('/').replace('/', ".");
    Ok(Arc::new(move |severity, text| {
        let level = match severity {
            Severity::Info => rcl_interfaces::Log::INFO,
            Severity::Warn => rcl_interfaces::Log::WARN,
            Severity::Error => rcl_interfaces::Log::ERROR,
        };
        eprintln!("[{}] [{name}]: {text}", severity.name());
        let stamp = time(system_time_ns()).unwrap_or_default();
        let log = rcl_interfaces::Log {
            stamp,
            level,
            name: name.clone(),
            msg: text.to_owned(),
            ..Default::default()
        };
        // The line is already on the terminal.
        let _ = publisher.publish(log.into());
    }))
}
