//! Versions of Webots: what differs between them on the wire.

use std::fmt;

use opendr_engine::{Error, Result};

use crate::kind::DeviceKind;

/// A version of Webots whose wire protocol the native client knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// Its configuration does not state a version, so it must be named.
    R2023a,
    /// The first one whose configuration begins with the name of the robot and the version.
    R2023b,
    /// Node and field requests differ from R2023b.
    R2025a,
}

/// Node number of a robot in R2023a; a node type before it was added in R2023b.
const ROBOT: u16 = 33;

impl Version {
    /// All known versions.
    pub const ALL: [Self; 3] = [Self::R2023a, Self::R2023b, Self::R2025a];

    /// Reads a version such as `R2023b` or `R2023b revision 1`: revisions of a version have one protocol.
    ///
    /// # Errors
    /// Returns `Unsupported` for an unknown version, with the known ones.
    pub fn parse(text: &str) -> Result<Self> {
        let known = |version: &Self| {
            let rest = text.strip_prefix(version.name());
            rest.is_some_and(|rest| !rest.starts_with(|next: char| next.is_ascii_alphanumeric()))
        };
        Self::ALL.into_iter().find(known).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            Error::unsupported(format!(
                "the protocol of Webots {text:?} is not known (known: {names}); connect with its libController \
                 (build with the feature webots-library and set link to library)"
            ))
        })
    }

    /// Returns the name, such as `R2023b`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::R2023a => "R2023a",
            Self::R2023b => "R2023b",
            Self::R2025a => "R2025a",
        }
    }

    /// Returns whether the configuration begins with the name of the robot and the version.
    pub(crate) const fn is_stated(self) -> bool {
        !matches!(self, Self::R2023a)
    }

    /// Returns whether requests for nodes and fields of the scene are known.
    pub(crate) const fn has_scene_requests(self) -> bool {
        matches!(self, Self::R2023a | Self::R2023b)
    }

    /// Returns the node number of a robot.
    pub const fn robot_node(self) -> u16 {
        if self.is_stated() { ROBOT + 1 } else { ROBOT }
    }

    /// Returns the node number of a device.
    pub const fn device_node(self, kind: DeviceKind) -> u16 {
        self.robot_node() + kind.after_robot()
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn unknown_versions_are_refused() {
        assert_eq!(Version::parse("R2023b").unwrap(), Version::R2023b);
        assert_eq!(Version::parse("R2023b revision 1").unwrap(), Version::R2023b);
        assert_eq!(Version::parse("R2025a-rev2").unwrap(), Version::R2025a);
        for text in ["", "R2022b", "R2023", "R2023bc", "R2025b", "2023a"] {
            let error = Version::parse(text).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Unsupported);
            assert!(error.to_string().contains("R2023a, R2023b, R2025a"));
        }
    }

    #[test]
    fn node_numbers_are_those_of_nodes_h() {
        assert_eq!(Version::R2023a.device_node(DeviceKind::RotationalMotor), 56);
        assert_eq!(Version::R2023a.device_node(DeviceKind::Camera), 37);
        assert_eq!(Version::R2025a.robot_node(), 34);
        assert_eq!(Version::R2025a.device_node(DeviceKind::Accelerometer), 35);
    }
}
