//! Priors of this crate: PID, LQR and scripted teachers for the environments of `opendr-simulation`.

mod cart_pole;
mod pendulum;
mod planar;
mod quad_track;

use opendr_rl::prior::Prior;

pub use quad_track::tuned_gains as quad_track_gains;

/// Returns the priors of this crate. `opendr-rl` cannot name them, since it is below; the facade registers them with its learners
/// ([`Prior::provide`]).
pub fn priors() -> Vec<Prior> {
    [cart_pole::priors(), pendulum::priors(), planar::priors(), quad_track::priors()].concat()
}
