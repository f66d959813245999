//! Fields that only one of the two formats has.

/// Name of the struct with a `seq` before its fields in ROS 1.
pub(super) const HEADER: &str = "Header";

/// Dummy field of messages without fields, which ROS 1 does not write.
pub(super) const EMPTY_FIELD: &str = "structure_needs_at_least_one_member";
