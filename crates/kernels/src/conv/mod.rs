//! Convolutions of tensors with channels last, and of planar images with few channels: forward only.
//!
//! A convolution is a product whose left rows are read where they lie: for each tap of the kernel, the channels of the
//! input pixel below it. No patches are copied.

mod depthwise;
mod filters;
mod geometry;
mod pair;
mod piece;
#[cfg(test)]
mod tests;
mod tile;
mod winograd;

pub use depthwise::{DepthwiseConvolution, DepthwiseFilters};
pub use filters::Filters;
pub use geometry::{Convolution, Finish, Strides, Window};
pub use pair::DepthwisePointwise;
pub use winograd::{Winograd, WinogradFilters};
