//! Convolutions of tensors with channels last, and of planar images with few channels: forward only.
//!
//! A convolution is a product whose left rows are read where they lie: for each tap of the kernel, the channels of the
//! input pixel below it. No patches are copied.

use std::sync::Arc;

use crate::compute::Compute;
use crate::unary::Unary;

mod depthwise;
mod filters;
mod piece;
#[cfg(test)]
mod tests;
mod tile;

pub use depthwise::DepthwiseFilters;
pub use filters::Filters;

/// Geometry of a convolution of two spatial dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Height and width of the kernel.
    pub kernel: [usize; 2],
    /// Steps between output pixels.
    pub strides: [usize; 2],
    /// Steps between taps.
    pub dilations: [usize; 2],
    /// Zeros above and to the left.
    pub pads: [usize; 2],
    /// Height and width of the input.
    pub input: [usize; 2],
    /// Height and width of the output.
    pub output: [usize; 2],
}

impl Window {
    /// Returns whether each output pixel depends on the input pixel of the same index only.
    pub fn is_pointwise(&self) -> bool {
        self.kernel == [1, 1] && self.strides == [1, 1] && self.pads == [0, 0] && self.input == self.output
    }
}

/// Where the numbers of a tensor lie: the strides of images, rows, pixels and channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Strides {
    /// From one image of the batch to the next.
    pub image: usize,
    /// From one row to the next.
    pub row: usize,
    /// From one pixel to the next.
    pub pixel: usize,
    /// From one channel to the next.
    pub channel: usize,
}

impl Strides {
    /// Returns those of a tensor with channels last.
    pub fn channels_last([height, width]: [usize; 2], channels: usize) -> Self {
        Self { image: height * width * channels, row: width * channels, pixel: channels, channel: 1 }
    }

    /// Returns those of a tensor of planes.
    pub fn planar([height, width]: [usize; 2], channels: usize) -> Self {
        Self { image: height * width * channels, row: width, pixel: 1, channel: height * width }
    }
}

/// What follows the sums: `activation(sum + bias + residual)`, or the residual after the activation.
#[derive(Debug, Clone, Default)]
pub struct Finish {
    /// The activation function.
    pub activation: Unary,
    /// Slopes of negative numbers, one per output channel, instead of the activation function.
    pub slopes: Option<Arc<[f32]>>,
    /// Whether the residual is added after the activation.
    pub residual_last: bool,
}

/// A convolution of known shapes: weights, geometry and what follows the sums.
#[derive(Debug, Clone)]
pub struct Convolution {
    /// Weights and bias.
    pub filters: Arc<Filters>,
    /// Geometry.
    pub window: Window,
    /// Number of images.
    pub batch: usize,
    /// Layout of the input.
    pub x: Strides,
    /// Layout of the output; its channels lie side by side.
    pub y: Strides,
    /// Layout of the residual, as that of the output.
    pub residual: Strides,
    /// What follows the sums.
    pub finish: Finish,
}

impl Convolution {
    /// Computes the convolution. `residual` has the shape of the output.
    ///
    /// # Panics
    /// When the slices are shorter than the shapes and strides require.
    pub fn run(&self, compute: &Compute, x: &[f32], residual: Option<&[f32]>, y: &mut [f32]) {
        let Window { input, output, .. } = self.window;
        let filters = &*self.filters;
        if self.batch == 0 || output.contains(&0) || filters.outputs() == 0 {
            return;
        }
        assert_eq!(filters.kernel(), self.window.kernel, "the filters must have the size of the kernel");
        assert_eq!(self.y.channel, 1, "the channels of the output must lie side by side");
        let reach = |at: Strides, [height, width]: [usize; 2], channels: usize| {
            (self.batch - 1) * at.image
                + height.saturating_sub(1) * at.row
                + width.saturating_sub(1) * at.pixel
                + channels.saturating_sub(1) * at.channel
                + 1
        };
        assert!(input.contains(&0) || x.len() >= reach(self.x, input, filters.channels()), "the input is too short");
        assert!(y.len() >= reach(self.y, output, filters.outputs()), "the output is too short");
        if let Some(residual) = residual {
            assert_eq!(self.residual.channel, 1, "the channels of the residual must lie side by side");
            assert!(residual.len() >= reach(self.residual, output, filters.outputs()), "the residual is too short");
        }
        if let Some(slopes) = &self.finish.slopes {
            assert!(slopes.len() >= filters.padded_outputs(), "one slope per output channel, rounded up");
        }
        piece::run(self, compute, x, residual, y);
    }
}
