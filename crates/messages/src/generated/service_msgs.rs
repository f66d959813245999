//! `service_msgs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `service_msgs/ServiceEventInfo`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ServiceEventInfo {
    pub event_type: u8,
    pub stamp: crate::builtin_interfaces::Time,
    pub client_gid: [u8; 16],
    pub sequence_number: i64,
}

#[allow(missing_docs)]
impl ServiceEventInfo {
    pub const REQUEST_SENT: u8 = 0;
    pub const REQUEST_RECEIVED: u8 = 1;
    pub const RESPONSE_SENT: u8 = 2;
    pub const RESPONSE_RECEIVED: u8 = 3;
}
