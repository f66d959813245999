//! `std_srvs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// Request of `std_srvs/Empty`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EmptyRequest {
    /// ROS 2's filling of a message without fields; ROS 1 writes nothing.
    pub structure_needs_at_least_one_member: u8,
}

/// Response of `std_srvs/Empty`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EmptyResponse {
    /// ROS 2's filling of a message without fields; ROS 1 writes nothing.
    pub structure_needs_at_least_one_member: u8,
}

/// Request of `std_srvs/SetBool`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetBoolRequest {
    pub data: bool,
}

/// Response of `std_srvs/SetBool`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetBoolResponse {
    pub success: bool,
    pub message: String,
}

/// Request of `std_srvs/Trigger`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TriggerRequest {
    /// ROS 2's filling of a message without fields; ROS 1 writes nothing.
    pub structure_needs_at_least_one_member: u8,
}

/// Response of `std_srvs/Trigger`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TriggerResponse {
    pub success: bool,
    pub message: String,
}
