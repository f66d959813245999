//! Convolutions whose weights change from call to call, with the gradients of input and weights, of tensors with channels last.

use std::sync::Arc;

use super::depthwise::{DepthwiseConvolution, DepthwiseFilters};
use super::filters::Filters;
use super::geometry::{Convolution, Finish, Strides, Window};
use super::phases::{phases, window_of_phase};
use super::winograd::{Winograd, WinogradFilters};
use crate::aligned::written;
use crate::compute::Compute;

/// Pixels from which on Winograd's transforms of the weights cost less than they save.
const WINOGRAD_PIXELS: usize = 512;

/// Sizes of a convolution of images with channels last. Its weights are `[outputs, channels / groups, height, width]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrainingConvolution {
    /// Number of images.
    pub batch: usize,
    /// Channels of the input.
    pub channels: usize,
    /// Channels of the output.
    pub outputs: usize,
    /// Number of groups.
    pub groups: usize,
    /// Geometry.
    pub window: Window,
}

/// The part of a convolution that differs between the forward pass and the phases of the input's gradient.
struct Part {
    window: Window,
    channels: usize,
    outputs: usize,
    x: Strides,
    y: Strides,
}

impl TrainingConvolution {
    /// Returns the number of numbers of the input.
    pub fn input_length(&self) -> usize {
        self.batch * self.window.input[0] * self.window.input[1] * self.channels
    }

    /// Returns the number of numbers of the output.
    pub fn output_length(&self) -> usize {
        self.batch * self.window.output[0] * self.window.output[1] * self.outputs
    }

    /// Returns the number of weights.
    pub fn weights_length(&self) -> usize {
        self.outputs * self.group_channels() * self.taps()
    }

    pub(super) fn taps(&self) -> usize {
        self.window.kernel[0] * self.window.kernel[1]
    }

    pub(super) fn group_channels(&self) -> usize {
        self.channels / self.groups
    }

    pub(super) fn group_outputs(&self) -> usize {
        self.outputs / self.groups
    }

    pub(super) fn is_depthwise(&self) -> bool {
        self.groups > 1 && self.groups == self.channels && self.groups == self.outputs
    }

    pub(super) fn check(&self, x: usize, weights: usize, y: usize) {
        let is_divided = self.groups > 0
            && self.channels.is_multiple_of(self.groups)
            && self.outputs.is_multiple_of(self.groups);
        assert!(is_divided, "the groups must divide the channels and the outputs");
        assert_eq!(x, self.input_length(), "the input must have the stated size");
        assert_eq!(weights, self.weights_length(), "the weights must have the stated size");
        assert_eq!(y, self.output_length(), "the output must have the stated size");
    }

    /// Returns the output.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn forward(&self, compute: &Compute, x: &[f32], weights: &[f32], bias: Option<&[f32]>) -> Vec<f32> {
        let length = self.output_length();
        self.check(x.len(), weights.len(), length);
        let part = Part {
            window: self.window,
            channels: self.channels,
            outputs: self.outputs,
            x: Strides::channels_last(self.window.input, self.channels),
            y: Strides::channels_last(self.window.output, self.outputs),
        };
        // SAFETY: the convolution writes every number of the output.
        unsafe {
            written(length, |y| self.run(compute, &part, x, weights, bias, [y, y.wrapping_add(length)])).0
        }
    }

    /// Computes a part with weights of its own, to numbers from the first pointer to the second one.
    ///
    /// # Safety
    /// The numbers may be written, and nothing else uses them.
    unsafe fn run(
        &self,
        compute: &Compute,
        part: &Part,
        x: &[f32],
        weights: &[f32],
        bias: Option<&[f32]>,
        [y, end]: [*mut f32; 2],
    ) {
        let length = (end.addr() - y.addr()) / size_of::<f32>();
        let &Part { window, channels, outputs, x: x_strides, y: y_strides } = part;
        let (groups, batch, finish) = (self.groups, self.batch, Finish::default());
        let pixels = batch * window.output[0] * window.output[1];
        let is_whole = x_strides == Strides::channels_last(window.input, channels);
        if self.is_depthwise() {
            let filters = Arc::new(DepthwiseFilters::new(weights, channels, window.kernel, bias));
            let conv = DepthwiseConvolution { filters, window, batch, x: x_strides, y: y_strides, finish };
            // SAFETY: passed on.
            unsafe { conv.run_to(compute, x, y, length) };
        } else if groups == 1
            && is_whole
            && pixels >= WINOGRAD_PIXELS
            && Winograd::has_kernel(&window, [outputs, channels])
        {
            let filters = Arc::new(WinogradFilters::new(compute, weights, [outputs, channels], bias));
            let conv = Winograd { filters, window, batch, y: y_strides, finish };
            // SAFETY: passed on.
            unsafe { conv.run_to(compute, x, None, y, length) };
        } else {
            let sizes = [groups, outputs / groups, channels / groups];
            let filters = Arc::new(Filters::new(compute, weights, sizes, window.kernel, bias, false));
            let conv = Convolution {
                filters,
                window,
                batch,
                x: x_strides,
                y: y_strides,
                residual: y_strides,
                finish,
            };
            // SAFETY: passed on.
            unsafe { conv.run_to(compute, x, None, y, length) };
        }
    }

    /// Returns the gradient of the input from that of the output.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn input_gradient(&self, compute: &Compute, weights: &[f32], dy: &[f32]) -> Vec<f32> {
        let length = self.input_length();
        self.check(length, weights.len(), dy.len());
        // SAFETY: the phases write every number of the gradient, or it is filled with zeros.
        unsafe { written(length, |dx| self.phases(compute, weights, dy, [dx, dx.wrapping_add(length)])).0 }
    }

    /// Computes the phases of the input's gradient, to numbers from the first pointer to the second one.
    ///
    /// # Safety
    /// The numbers may be written, and nothing else uses them.
    unsafe fn phases(&self, compute: &Compute, weights: &[f32], dy: &[f32], [dx, end]: [*mut f32; 2]) {
        let Window { kernel, strides, dilations, pads, input, output } = self.window;
        let axis =
            |axis: usize| phases(kernel[axis], strides[axis], dilations[axis], pads[axis], input[axis]);
        let (rows, columns) = (axis(0), axis(1));
        let (whole_x, whole_y) =
            (Strides::channels_last(input, self.channels), Strides::channels_last(output, self.outputs));
        let all_phases = || rows.iter().flat_map(|row| columns.iter().map(move |column| [row, column]));
        if all_phases().any(|phases| phases.iter().any(|phase| phase.taps.is_empty())) {
            // SAFETY: passed on.
            unsafe { dx.write_bytes(0, self.input_length()) };
        }
        for (row_index, row) in rows.iter().enumerate() {
            for (column_index, column) in columns.iter().enumerate() {
                if row.taps.is_empty() || column.taps.is_empty() {
                    continue;
                }
                let (window, begin) = window_of_phase([row, column], output);
                let part = Part {
                    window,
                    channels: self.outputs,
                    outputs: self.channels,
                    x: whole_y,
                    y: Strides {
                        row: strides[0] * whole_x.row,
                        pixel: strides[1] * whole_x.pixel,
                        ..whole_x
                    },
                };
                let weights = self.transposed(compute, weights, &row.taps, &column.taps);
                let from = begin[0] * whole_y.row + begin[1] * whole_y.pixel;
                let to = row_index * whole_x.row + column_index * whole_x.pixel;
                let dy = dy.get(from..).unwrap_or_default();
                // SAFETY: the phase begins within the gradient, and its convolution checks where it ends.
                unsafe { self.run(compute, &part, dy, &weights, None, [dx.wrapping_add(to).min(end), end]) };
            }
        }
    }

    /// Returns weights of these taps, `[channels, outputs / groups, rows, columns]`.
    fn transposed(&self, compute: &Compute, weights: &[f32], rows: &[usize], columns: &[usize]) -> Vec<f32> {
        let (inputs, outputs) = (self.group_channels(), self.group_outputs());
        let (taps, own) = (self.taps(), rows.len() * columns.len());
        let width = self.window.kernel[1];
        let order: Vec<usize> =
            rows.iter().flat_map(|row| columns.iter().map(move |column| row * width + column)).collect();
        let mut all = vec![0.0; self.channels * outputs * own];
        compute.pool().run_on_pieces(&mut all, outputs * own, |channel, all| {
            let (group, input) = (channel / inputs, channel % inputs);
            for (output, to) in all.chunks_mut(own).enumerate() {
                let from = &weights[((group * outputs + output) * inputs + input) * taps..][..taps];
                to.iter_mut().zip(&order).for_each(|(to, &tap)| *to = from[tap]);
            }
        });
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isa::Isa;
    use crate::reference::{assert_near, random};

    /// Distance between a number and its f64 reference, relative to the largest one.
    const TOLERANCE: f64 = 2e-5;

    /// Calls a function with the indices of input, weight and output of every product.
    fn products(conv: &TrainingConvolution, mut each: impl FnMut(usize, usize, usize)) {
        let Window { kernel, strides, dilations, pads, input, output } = conv.window;
        let (inputs, outputs) = (conv.group_channels(), conv.group_outputs());
        for image in 0..conv.batch {
            for (oy, ox) in (0..output[0]).flat_map(|y| (0..output[1]).map(move |x| (y, x))) {
                for (ky, kx) in (0..kernel[0]).flat_map(|y| (0..kernel[1]).map(move |x| (y, x))) {
                    let iy = (oy * strides[0] + ky * dilations[0]).checked_sub(pads[0]);
                    let ix = (ox * strides[1] + kx * dilations[1]).checked_sub(pads[1]);
                    let (Some(iy), Some(ix)) = (iy.filter(|&y| y < input[0]), ix.filter(|&x| x < input[1]))
                    else {
                        continue;
                    };
                    let x = ((image * input[0] + iy) * input[1] + ix) * conv.channels;
                    let y = ((image * output[0] + oy) * output[1] + ox) * conv.outputs;
                    for out in 0..conv.outputs {
                        for inner in 0..inputs {
                            let weight = ((out * inputs + inner) * kernel[0] + ky) * kernel[1] + kx;
                            each(x + out / outputs * inputs + inner, weight, y + out);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn passes_equal_their_definition() {
        let mut cases = Vec::new();
        for (channels, outputs, groups) in [
            (3, 20, 1),
            (20, 3, 1),
            (16, 32, 1),
            (33, 29, 1),
            (40, 40, 40),
            (5, 5, 5),
            (70, 70, 70),
            (12, 18, 3),
            (48, 16, 1),
        ] {
            for (kernel, stride, dilation, pads, input) in [
                ([1, 1], [1, 1], [1, 1], [0, 0, 0, 0], [5, 7]),
                ([1, 1], [2, 2], [1, 1], [0, 0, 0, 0], [6, 7]),
                ([3, 3], [1, 1], [1, 1], [1, 1, 1, 1], [9, 30]),
                ([3, 3], [2, 2], [1, 1], [1, 1, 1, 1], [8, 9]),
                ([3, 3], [1, 1], [2, 3], [2, 3, 2, 3], [7, 8]),
                ([3, 2], [2, 3], [1, 1], [2, 0, 1, 3], [7, 8]),
                ([5, 5], [1, 1], [1, 1], [5, 0, 4, 6], [4, 5]),
                ([2, 2], [3, 3], [1, 1], [0, 0, 0, 0], [8, 8]),
            ] {
                cases.push((channels, outputs, groups, kernel, stride, dilation, pads, input));
            }
        }
        for (channels, outputs, groups, kernel, strides, dilations, pads, input) in cases {
            let output = [0, 1].map(|i| {
                (input[i] + pads[i] + pads[i + 2] - (kernel[i] - 1) * dilations[i] - 1) / strides[i] + 1
            });
            let window = Window { kernel, strides, dilations, pads: [pads[0], pads[1]], input, output };
            let conv = TrainingConvolution { batch: 2, channels, outputs, groups, window };
            let (x, weights) = (random(conv.input_length(), 1), random(conv.weights_length(), 2));
            let (dy, bias) = (random(conv.output_length(), 3), random(outputs, 4));
            let mut y_wanted: Vec<f64> = (0..dy.len()).map(|i| f64::from(bias[i % outputs])).collect();
            let mut dx_wanted = vec![0.0; x.len()];
            let mut dw_wanted = vec![0.0; weights.len()];
            products(&conv, |i, w, o| {
                y_wanted[o] += f64::from(x[i]) * f64::from(weights[w]);
                dx_wanted[i] += f64::from(dy[o]) * f64::from(weights[w]);
                dw_wanted[w] += f64::from(dy[o]) * f64::from(x[i]);
            });
            for isa in Isa::available() {
                let mut of_one = None;
                for threads in [1, 3] {
                    let pool = Arc::new(crate::pool::WorkerPool::new(threads));
                    let compute = Compute::new(isa, pool);
                    let mut dw = vec![9.0; weights.len()];
                    conv.weight_gradient(&compute, &x, &dy, &mut dw);
                    let y = conv.forward(&compute, &x, &weights, Some(&bias));
                    let results = [y, conv.input_gradient(&compute, &weights, &dy), dw];
                    let [y, dx, dw] = &results;
                    assert_near(y, &y_wanted, TOLERANCE, &format!("output of {conv:?}, {isa}"));
                    assert_near(
                        dx,
                        &dx_wanted,
                        TOLERANCE,
                        &format!("gradient of the input of {conv:?}, {isa}"),
                    );
                    assert_near(
                        dw,
                        &dw_wanted,
                        TOLERANCE,
                        &format!("gradient of the weights of {conv:?}, {isa}"),
                    );
                    let one = of_one.get_or_insert_with(|| results.clone());
                    assert_eq!(*one, results, "{conv:?}, {isa}: threads change the bits");
                }
            }
        }
    }
}
