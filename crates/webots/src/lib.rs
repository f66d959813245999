//! Robots in the simulator Webots as environments, and worlds for it.
//!
//! - [`WebotsLink`] is the connection of an external controller: [`NativeLink`] speaks the wire protocol of the versions in
//!   [`Version`] and needs no installation; with the feature `webots-library`, `LibraryLink` loads the user's `libController`.
//! - [`WebotsEnvironment`] makes a robot an environment: its motors are the actions, its sensors the observations.
//! - [`export()`] writes the worlds of `opendr-simulation` as world files of Webots.
//!
//! Nothing of this crate was run against Webots itself: `docs/webots.md` says what was run against what.

mod device;
mod environment;
mod export;
mod incoming;
mod kind;
#[cfg(feature = "webots-library")]
mod library;
mod link;
mod native;
mod reader;
mod request;
mod scene;
mod url;
mod version;

pub use environment::{ID, LinkKind, WebotsEnvironment, WebotsParams, registration};
pub use export::{WorldFiles, export};
pub use kind::DeviceKind;
#[cfg(feature = "webots-library")]
pub use library::LibraryLink;
pub use link::{DeviceInfo, MotorCommand, RobotInfo, StepEnd, WebotsLink};
pub use native::NativeLink;
pub use scene::{FieldKind, FieldRef, FieldValue, NodeRef, Supervisor};
pub use url::ControllerUrl;
pub use version::Version;
