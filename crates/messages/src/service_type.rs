//! What services know of themselves.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A service: what is asked and what is answered.
pub trait RosService {
    /// What is asked.
    type Request: Clone + Default + Serialize + DeserializeOwned + Send + Sync + 'static;
    /// What is answered.
    type Response: Clone + Default + Serialize + DeserializeOwned + Send + Sync + 'static;
    /// Its names and sums.
    const TYPE: ServiceType;
}

/// What two nodes compare before one serves the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ServiceType {
    /// The package, e.g. `"std_srvs"`.
    pub package: &'static str,
    /// The name, e.g. `"Trigger"`.
    pub name: &'static str,
    /// ROS 1's sum.
    pub md5sum: &'static str,
    /// ROS 2's hash.
    pub rihs01: &'static str,
}
