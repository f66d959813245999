//! Demonstrations and where they are from.

use opendr_engine::environment::Space;

use crate::demonstrations::DemonstrationSet;

/// Demonstrations with their spaces, and where they are from.
pub(crate) struct Source {
    pub set: DemonstrationSet,
    pub spaces: [Space; 2],
    /// Id of the environment; none if the demonstrations are those of a robot.
    pub environment: Option<String>,
}
