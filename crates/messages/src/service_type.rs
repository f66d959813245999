//! What services know of themselves.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A service: what is asked and what is answered.
pub trait RosService {
    /// What is asked.
    type Request: Clone + Default + Serialize + DeserializeOwned + Send + 'static;
    /// What is answered.
    type Response: Clone + Default + Serialize + DeserializeOwned + Send + 'static;
    /// The package, e.g. `"std_srvs"`.
    const PACKAGE: &'static str;
    /// The name, e.g. `"Trigger"`.
    const NAME: &'static str;
    /// ROS 1's sum.
    const MD5SUM: &'static str;
    /// ROS 2's hash.
    const RIHS01: &'static str;
}
