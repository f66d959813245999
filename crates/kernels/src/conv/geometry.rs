//! Geometry, layout, and what follows the sums.

use std::sync::Arc;

use super::filters::Filters;
use crate::cost::LayerCost;
use crate::unary::Unary;

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

    /// Returns the input index below the first tap of an output index along an axis, which may be negative.
    pub(super) fn first_tap(&self, axis: usize, output: usize) -> isize {
        (output * self.strides[axis]) as isize - self.pads[axis] as isize
    }

    /// Returns the first tap along an axis that lies within the input, and the one behind the last, where the first of all lies at `at`.
    pub(super) fn taps_inside(&self, axis: usize, at: isize) -> [usize; 2] {
        let (kernel, dilation) = (self.kernel[axis], self.dilations[axis]);
        let before = |index: isize| (index.max(0) as usize).div_ceil(dilation).min(kernel);
        let first = before(-at);
        [first, before(self.input[axis] as isize - at).max(first)]
    }

    /// Returns whether each output pixel depends on input pixels of its column only, and the next row on those one row below.
    pub fn is_columnwise(&self) -> bool {
        self.kernel[1] == 1 && self.strides == [1, 1] && self.pads[1] == 0 && self.input[1] == self.output[1]
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

    /// Panics unless the numbers of a tensor lie apart from each other, so that threads can write it.
    pub(super) fn check_written(&self, [height, width]: [usize; 2], channels: usize) {
        let apart = self.channel == 1
            && self.pixel >= channels
            && (height <= 1 || self.row >= (width - 1) * self.pixel + channels)
            && self.image >= (height - 1) * self.row + (width - 1) * self.pixel + channels;
        assert!(apart, "channels, pixels and rows of the output must lie apart");
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
    /// Returns the arithmetic and the bytes of the weights.
    pub fn cost(&self) -> LayerCost {
        let Window { kernel, output, .. } = self.window;
        let per_output = self.filters.channels() / self.filters.groups().max(1);
        let factors =
            [self.batch, output[0], output[1], self.filters.outputs(), per_output, kernel[0], kernel[1]];
        LayerCost::floats(&factors).with_weights(self.filters.bytes())
    }
}
