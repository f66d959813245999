//! Parameters of the environment.

use opendr_engine::params::Params;

/// Name and version of the environment.
pub const ID: &str = "Webots-v0";

opendr_engine::choices! {
    /// How to connect.
    pub enum LinkKind {
        /// By the client of the wire protocol.
        Native = "native",
        /// By the user's `libController`.
        Library = "library",
    }
}

/// Parameters of `Webots-v0`.
#[derive(Debug, Clone, Params)]
pub struct WebotsParams {
    /// Address of the robot: tcp://HOST:PORT/ROBOT or ipc://PORT/ROBOT; empty for that in WEBOTS_CONTROLLER_URL.
    #[param(default = "")]
    pub url: String,
    /// How to connect: native (the wire protocol) or library (the libController in WEBOTS_HOME; address by WEBOTS_CONTROLLER_URL).
    #[param(default = LinkKind::Native)]
    pub link: LinkKind,
    /// Version of Webots, such as R2025a; empty for the one that Webots states, as it does from R2023b on.
    #[param(default = "")]
    pub version: String,
    /// Motors that actions command, as NAME:CONTROL with control position, velocity or force, separated by commas; empty for all, by
    /// velocity.
    #[param(default = "")]
    pub motors: String,
    /// Sensors that are observed, separated by commas; empty for all.
    #[param(default = "")]
    pub sensors: String,
    /// Receiver whose packets are rewards; empty for a reward of 0 in episodes that only `max_steps` ends.
    #[param(default = "")]
    pub reward: String,
    /// Duration of a step in ms, a multiple of the world's time step; 0 for that itself.
    #[param(default = 0, range = 0..=60_000)]
    pub step_ms: i64,
    /// Number of steps after which an episode is truncated; 0 for no limit.
    #[param(default = 0, range = 0..=100_000_000)]
    pub max_steps: i64,
    /// Maximum seconds to wait for an answer; 0 waits forever, as a paused simulation needs.
    #[param(default = 0.0, range = 0.0..=86_400.0)]
    pub timeout: f64,
}

/// Returns the names in a list that is separated by commas.
pub(super) fn names(list: &str) -> impl Iterator<Item = &str> {
    list.split(',').map(str::trim).filter(|name| !name.is_empty())
}
