//! ROS 2, over DDS or Zenoh.

mod dds;
mod error;
mod lifecycle;
mod log;
mod parameter_services;
mod ros2_node;
mod typed_services;
#[cfg(feature = "zenoh")]
mod zenoh;

use std::net::IpAddr;
use std::str::FromStr;

use opendr_engine::{Error, Result};

use crate::Names;
pub use ros2_node::Ros2Node;

/// Middleware of ROS 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Middleware {
    /// DDS, compatible with Fast DDS and Cyclone DDS.
    Dds,
    /// Zenoh, compatible with `rmw_zenoh_cpp`; needs the feature `zenoh`.
    Zenoh,
}

impl FromStr for Middleware {
    type Err = Error;

    /// Parses `dds`, `zenoh`, or the name of an RMW implementation.
    fn from_str(text: &str) -> Result<Self> {
        match text {
            "zenoh" | "rmw_zenoh_cpp" => Ok(Self::Zenoh),
            "dds"
            | "rmw_fastrtps_cpp"
            | "rmw_fastrtps_dynamic_cpp"
            | "rmw_cyclonedds_cpp"
            | "rmw_connextdds" => Ok(Self::Dds),
            other => Err(Error::invalid_param(format!(
                "unknown middleware {other:?}; give dds, zenoh, or the name of an RMW implementation"
            ))),
        }
    }
}

/// Options for joining ROS 2.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ros2Options {
    /// Middleware (default: that of `RMW_IMPLEMENTATION`, else DDS).
    pub middleware: Option<Middleware>,
    /// Domain id (default: `ROS_DOMAIN_ID`, else 0).
    pub domain_id: Option<u16>,
    /// Addresses of the networks that DDS uses; all if empty.
    pub networks: Vec<IpAddr>,
}

/// A DDS participant or Zenoh session, shared by the nodes of a process.
pub struct Ros2(Joined);

enum Joined {
    Dds(dds::Participant),
    #[cfg(feature = "zenoh")]
    Zenoh(zenoh::Session),
}

impl Ros2 {
    /// Joins the domain.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid domain or middleware; `Unsupported` for a middleware that this build does not contain; `Io`
    /// when the network cannot be used.
    pub fn new(options: &Ros2Options) -> Result<Self> {
        let domain_id = match (options.domain_id, std::env::var("ROS_DOMAIN_ID")) {
            (Some(domain_id), _) => domain_id,
            (None, Ok(text)) if !text.is_empty() => text.parse().map_err(|_| {
                Error::invalid_param(format!("ROS_DOMAIN_ID is {text:?}; give a number from 0 to 232"))
            })?,
            _ => 0,
        };
        // The ports of higher domains exceed 65,535 (DDSI-RTPS 9.6.1.1).
        if domain_id > 232 {
            return Err(Error::invalid_param(format!(
                "the domain id is {domain_id}; give a number from 0 to 232"
            )));
        }
        let middleware = match (options.middleware, std::env::var("RMW_IMPLEMENTATION")) {
            (Some(middleware), _) => middleware,
            (None, Ok(text)) if !text.is_empty() => {
                text.parse().map_err(|error: Error| error.context("RMW_IMPLEMENTATION"))?
            }
            _ => Middleware::Dds,
        };
        match middleware {
            Middleware::Dds => Ok(Self(Joined::Dds(dds::Participant::new(domain_id, &options.networks)?))),
            #[cfg(feature = "zenoh")]
            Middleware::Zenoh => Ok(Self(Joined::Zenoh(zenoh::Session::new(domain_id)?))),
            #[cfg(not(feature = "zenoh"))]
            Middleware::Zenoh => Err(Error::unsupported(
                "this build supports only DDS: build with --features zenoh, or set RMW_IMPLEMENTATION to a DDS implementation",
            )),
        }
    }

    /// Creates a node in the domain.
    ///
    /// # Errors
    /// `InvalidInput` for invalid names; `Io` when the network cannot be used.
    pub fn node(&self, names: Names) -> Result<Box<dyn Ros2Node>> {
        match &self.0 {
            Joined::Dds(participant) => Ok(Box::new(participant.node(names)?)),
            #[cfg(feature = "zenoh")]
            Joined::Zenoh(session) => Ok(Box::new(session.node(names)?)),
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn middlewares_go_by_the_names_of_ros() {
        assert_eq!("rmw_zenoh_cpp".parse::<Middleware>().unwrap(), Middleware::Zenoh);
        assert_eq!("rmw_cyclonedds_cpp".parse::<Middleware>().unwrap(), Middleware::Dds);
        assert!("rmw_other".parse::<Middleware>().unwrap_err().to_string().contains("rmw_other"));
    }

    #[test]
    fn a_domain_that_has_no_ports_is_refused() {
        let options = Ros2Options { domain_id: Some(233), ..Ros2Options::default() };
        assert_eq!(Ros2::new(&options).err().map(|error| error.kind()), Some(ErrorKind::InvalidParam));
    }

    #[cfg(not(feature = "zenoh"))]
    #[test]
    fn a_build_without_zenoh_is_reported() {
        let options = Ros2Options { middleware: Some(Middleware::Zenoh), ..Ros2Options::default() };
        assert_eq!(Ros2::new(&options).err().map(|error| error.kind()), Some(ErrorKind::Unsupported));
    }
}
