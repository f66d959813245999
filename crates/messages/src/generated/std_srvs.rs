//! `std_srvs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `std_srvs/Empty, the request`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EmptyRequest {
    /// ROS 2's filling of a message without fields; ROS 1 writes nothing.
    pub structure_needs_at_least_one_member: u8,
}

/// `std_srvs/Empty, the response`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EmptyResponse {
    /// ROS 2's filling of a message without fields; ROS 1 writes nothing.
    pub structure_needs_at_least_one_member: u8,
}

/// `std_srvs/SetBool, the request`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetBoolRequest {
    pub data: bool,
}

/// `std_srvs/SetBool, the response`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetBoolResponse {
    pub success: bool,
    pub message: String,
}

/// `std_srvs/Trigger, the request`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TriggerRequest {
    /// ROS 2's filling of a message without fields; ROS 1 writes nothing.
    pub structure_needs_at_least_one_member: u8,
}

/// `std_srvs/Trigger, the response`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TriggerResponse {
    pub success: bool,
    pub message: String,
}
