//! Service types, and their names and hashes.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A service with its request and response.
pub trait RosService {
    /// Request.
    type Request: Clone + Default + Serialize + DeserializeOwned + Send + Sync + 'static;
    /// Response.
    type Response: Clone + Default + Serialize + DeserializeOwned + Send + Sync + 'static;
    /// Names and hashes.
    const TYPE: ServiceType;
}

/// Names and hashes of a service, which client and server compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ServiceType {
    /// Package, such as `"std_srvs"`.
    pub package: &'static str,
    /// Name, such as `"Trigger"`.
    pub name: &'static str,
    /// md5 sum of ROS 1.
    pub md5sum: &'static str,
    /// RIHS01 hash of ROS 2.
    pub rihs01: &'static str,
}
