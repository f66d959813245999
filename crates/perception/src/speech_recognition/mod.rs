//! Which word was spoken.

mod matchboxnet;
mod sound;

#[cfg(feature = "training")]
pub use matchboxnet::MatchboxNetFitParams;
pub use matchboxnet::{MatchboxNet, MatchboxNetParams, MatchboxNetStream};
pub use sound::Sound;
