//! Optimisers on flat parameters: one slice holds all numbers of a network, another their gradients.

mod adam;
mod gradient_norm;
mod momentum;
mod polyak;

pub use adam::{Adam, AdamOptions, WeightDecay};
pub use gradient_norm::{clip_gradient_norm, gradient_norm};
pub use momentum::Momentum;
pub use polyak::move_towards;
