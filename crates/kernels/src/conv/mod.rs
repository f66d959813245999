//! Convolutions of tensors with channels last, and of planar images with few channels, and the gradients of a training step.
//!
//! A convolution is a product whose left rows are read where they lie: for each tap of the kernel, the channels of the
//! input pixel below it. No patches are copied.

mod depthwise;
mod depthwise_gradient;
mod filters;
mod geometry;
mod pair;
mod phases;
mod piece;
mod pixel_products;
#[cfg(test)]
mod tests;
mod tile;
mod training;
mod weight_gradient;
mod winograd;
mod winograd_gradient;

pub use depthwise::{DepthwiseConvolution, DepthwiseFilters};
pub use filters::Filters;
pub use geometry::{Convolution, Finish, Strides, Window};
pub use pair::DepthwisePointwise;
pub use phases::{Phase, phases, window_of_phase};
pub use training::TrainingConvolution;
pub use winograd::{Winograd, WinogradFilters};
