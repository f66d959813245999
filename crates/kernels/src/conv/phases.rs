//! Transposed convolutions as convolutions: the output pixels whose distance is a multiple of the stride are a phase, of which each depends
//! on the same taps of the kernel.

use super::geometry::Window;

/// The taps of the kernel that reach the output pixels of a phase along one axis.
#[derive(Debug, Clone)]
pub struct Phase {
    /// Indices into the kernel, in the order of the input pixels that they multiply.
    pub taps: Vec<usize>,
    /// Distance of the first input pixel from the pixel with the index of the output pixel.
    pub offset: isize,
    /// Distance between input pixels.
    pub dilation: usize,
    /// Number of output pixels.
    pub length: usize,
}

/// Returns the phases along an axis that have pixels, for a kernel with a stride, dilation and padding, and the size of the output.
pub fn phases(kernel: usize, stride: usize, dilation: usize, pad: usize, output: usize) -> Vec<Phase> {
    let phase = |first: usize| {
        let mut taps: Vec<(isize, usize)> = (0..kernel)
            .rev()
            .map(|tap| ((first + pad) as isize - (tap * dilation) as isize, tap))
            .filter(|(at, _)| at.rem_euclid(stride as isize) == 0)
            .map(|(at, tap)| (at.div_euclid(stride as isize), tap))
            .collect();
        taps.sort_unstable();
        Phase {
            offset: taps.first().map_or(0, |first| first.0),
            dilation: taps.windows(2).map(|pair| pair[1].0 - pair[0].0).next().unwrap_or(1) as usize,
            taps: taps.into_iter().map(|(_, tap)| tap).collect(),
            length: (output - first).div_ceil(stride),
        }
    };
    (0..stride.min(output)).map(phase).collect()
}

/// Returns the window of the convolution of a phase, and the first pixel of its input: a first pixel behind the first one of the input
/// begins there.
pub fn window_of_phase([row, column]: [&Phase; 2], input: [usize; 2]) -> (Window, [usize; 2]) {
    let begin = [row, column].map(|phase| phase.offset.max(0) as usize);
    let window = Window {
        kernel: [row.taps.len(), column.taps.len()],
        strides: [1, 1],
        dilations: [row.dilation, column.dilation],
        pads: [row, column].map(|phase| (-phase.offset).max(0) as usize),
        input: [input[0].saturating_sub(begin[0]), input[1].saturating_sub(begin[1])],
        output: [row.length, column.length],
    };
    (window, begin)
}
