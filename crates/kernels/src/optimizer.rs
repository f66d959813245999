//! Optimisers on flat parameters: one slice for all parameters of a network, another for their gradients.

mod adam;
mod gradient_norm;
mod momentum;
mod polyak;

pub use adam::{Adam, AdamOptions, WeightDecay};
pub use gradient_norm::{clip_gradient_norm, gradient_norm};
pub use momentum::Momentum;
pub use polyak::polyak_update;
