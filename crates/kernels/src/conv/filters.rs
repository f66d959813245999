//! Weights in the order in which the inner loop reads them.

use crate::aligned::{AlignedBuffer, flush_below, negligible};
use crate::compute::Compute;
use crate::isa::{Isa, Set};
use crate::lanes::{self, Lanes};

/// Packed weights and bias of a convolution of one or more groups, for one instruction set.
pub struct Filters {
    isa: Isa,
    width: usize,
    /// Registers per panel.
    vectors: usize,
    groups: usize,
    /// Outputs per group.
    outputs: usize,
    /// Channels per group.
    channels: usize,
    kernel: [usize; 2],
    planar: bool,
    group_length: usize,
    panels: AlignedBuffer,
    /// Per group, filled up to whole registers.
    bias: Vec<f32>,
}

impl std::fmt::Debug for Filters {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { groups, outputs, channels, kernel, .. } = self;
        write!(f, "Filters({groups} groups of {outputs}x{channels}x{kernel:?})")
    }
}

impl Filters {
    /// Packs weights of the shape `[groups * outputs, channels, height, width]`. `planar` states that the input has
    /// planes of channels, which is faster for few channels. Weights below 1e-20 of the largest one count as zero.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn new(
        compute: &Compute,
        weights: &[f32],
        [groups, outputs, channels]: [usize; 3],
        kernel: [usize; 2],
        bias: Option<&[f32]>,
        planar: bool,
    ) -> Self {
        let taps = kernel[0] * kernel[1];
        assert_eq!(
            weights.len(),
            groups * outputs * channels * taps,
            "the weights must have the stated shape"
        );
        let strides = [channels * taps, taps, 1];
        let source = Source { weights, strides };
        Self::from_source(compute, &source, [groups, outputs, channels], kernel, bias, planar)
    }

    /// Packs a matrix `[depth, columns]` (transposed: `[columns, depth]`) as the filters of a product.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn from_matrix(
        compute: &Compute,
        matrix: &[f32],
        [depth, columns]: [usize; 2],
        transposed: bool,
        bias: Option<&[f32]>,
    ) -> Self {
        assert_eq!(matrix.len(), depth * columns, "the matrix must have the stated shape");
        let strides = if transposed { [depth, 1, 1] } else { [1, columns, 1] };
        let source = Source { weights: matrix, strides };
        Self::from_source(compute, &source, [1, columns, depth], [1, 1], bias, false)
    }

    fn from_source(
        compute: &Compute,
        source: &Source<'_>,
        [groups, outputs, channels]: [usize; 3],
        kernel: [usize; 2],
        bias: Option<&[f32]>,
        planar: bool,
    ) -> Self {
        let mut filters = Self::zeros(compute, [groups, outputs, channels], kernel, bias, planar);
        let steps = source.steps(channels, kernel, planar);
        let panel_outputs = filters.vectors * filters.width;
        let least = negligible(source.weights);
        let pack = |group: usize, first: usize, panel: &mut [f32]| {
            let used = panel_outputs.min(outputs - first);
            source.pack(group * outputs + first, used, &steps, panel);
            flush_below(panel, least);
        };
        let panel_length = (panel_outputs * filters.depth()).max(1);
        let group_length = filters.group_length;
        let packed = filters.panels.take(group_length * groups);
        if groups == 1 {
            compute.pool().run_on_pieces(packed, panel_length, |index, panel| {
                pack(0, index * panel_outputs, panel);
            });
        } else {
            compute.pool().run_on_pieces(packed, group_length.max(1), |group, all| {
                let panels = all.chunks_mut(panel_length).enumerate();
                panels.for_each(|(index, panel)| pack(group, index * panel_outputs, panel));
            });
        }
        filters
    }

    /// Creates filters whose weights are zero.
    pub(super) fn zeros(
        compute: &Compute,
        [groups, outputs, channels]: [usize; 3],
        kernel: [usize; 2],
        bias: Option<&[f32]>,
        planar: bool,
    ) -> Self {
        let isa = compute.isa();
        let width = width_of(isa);
        let blocks = outputs.div_ceil(width);
        let vectors = if blocks.is_multiple_of(3) || blocks > 6 { 3 } else { 2 }.min(blocks.max(1));
        let group_length = blocks * width * kernel[0] * kernel[1] * channels;
        let mut panels = AlignedBuffer::default();
        panels.take(group_length * groups);
        let padded = blocks * width;
        let mut padded_bias = vec![0.0; padded * groups];
        if let Some(bias) = bias {
            assert_eq!(bias.len(), outputs * groups, "one bias per output");
            for (to, from) in padded_bias.chunks_mut(padded.max(1)).zip(bias.chunks(outputs.max(1))) {
                to[..from.len()].copy_from_slice(from);
            }
        }
        Self {
            isa,
            width,
            vectors,
            groups,
            outputs,
            channels,
            kernel,
            planar,
            group_length,
            panels,
            bias: padded_bias,
        }
    }

    /// Returns the weights of a panel of one group, in rows of as many numbers as its registers have.
    pub(super) fn weights_mut(&mut self, panel: usize) -> &mut [f32] {
        let (first, length) = (panel * self.vectors * self.width * self.depth(), self.group_length);
        let panel_length = self.vectors * self.width * self.depth();
        let end = (first + panel_length).min(length);
        &mut self.panels.take(length)[first..end]
    }

    /// Returns the outputs of a panel.
    pub(super) fn panel_outputs(&self) -> usize {
        self.vectors * self.width
    }

    /// Returns the number of output channels.
    pub fn outputs(&self) -> usize {
        self.outputs * self.groups
    }

    /// Returns the number of input channels.
    pub fn channels(&self) -> usize {
        self.channels * self.groups
    }

    /// Returns the number of outputs of all groups, each rounded up to whole registers.
    pub fn padded_outputs(&self) -> usize {
        self.bias.len()
    }

    /// Returns `values`, one per output, with the padding of the bias.
    pub fn padded(&self, values: &[f32]) -> Vec<f32> {
        let padded = self.bias.len() / self.groups.max(1);
        let mut all = vec![0.0; self.bias.len()];
        for (to, from) in all.chunks_mut(padded.max(1)).zip(values.chunks(self.outputs.max(1))) {
            to[..from.len()].copy_from_slice(from);
        }
        all
    }

    /// Returns the bytes of the packed weights.
    pub fn bytes(&self) -> usize {
        4 * (self.group_length * self.groups + self.bias.len())
    }

    pub(super) fn kernel(&self) -> [usize; 2] {
        self.kernel
    }

    pub(super) fn isa(&self) -> Isa {
        self.isa
    }

    pub(super) fn groups(&self) -> usize {
        self.groups
    }

    pub(super) fn is_planar(&self) -> bool {
        self.planar
    }

    pub(super) fn group_outputs(&self) -> usize {
        self.outputs
    }

    pub(super) fn group_channels(&self) -> usize {
        self.channels
    }

    pub(super) fn depth(&self) -> usize {
        self.kernel[0] * self.kernel[1] * self.channels
    }

    pub(super) fn panel_count(&self) -> usize {
        self.outputs.div_ceil(self.width).div_ceil(self.vectors)
    }

    /// Returns a panel: its weights, bias, first output, and number of registers across.
    pub(super) fn panel(&self, group: usize, index: usize) -> Panel {
        let first = index * self.vectors * self.width;
        let blocks = self.outputs.div_ceil(self.width);
        let from = group * self.group_length + first * self.depth();
        let padded = blocks * self.width;
        Panel {
            weights: self.panels.start().wrapping_add(from),
            bias: self.bias.as_ptr().wrapping_add(group * padded + first),
            padded_first: group * padded + first,
            first: group * self.outputs + first,
            used: self.outputs - first,
            vectors: self.vectors.min(blocks - index * self.vectors),
        }
    }
}

/// Weights as a file has them.
struct Source<'a> {
    weights: &'a [f32],
    /// Distances between outputs, channels and taps.
    strides: [usize; 3],
}

impl Source<'_> {
    /// Returns each weight of an output, in the order of the memory: its distance from the first one, and its step within a panel.
    fn steps(&self, channels: usize, kernel: [usize; 2], planar: bool) -> Vec<(usize, usize)> {
        let [_, channel_stride, tap_stride] = self.strides;
        let taps = kernel[0] * kernel[1];
        let step = |channel: usize, tap: usize| {
            if planar {
                (tap / kernel[1] * channels + channel) * kernel[1] + tap % kernel[1]
            } else {
                tap * channels + channel
            }
        };
        let of_channel = |channel: usize| {
            (0..taps).map(move |tap| (channel * channel_stride + tap * tap_stride, step(channel, tap)))
        };
        (0..channels).flat_map(of_channel).collect()
    }

    /// Writes `used` outputs from `first` on to a panel, which has a row of outputs per step.
    fn pack(&self, first: usize, used: usize, steps: &[(usize, usize)], panel: &mut [f32]) {
        /// Steps per pass over the outputs: their weights are a line of the cache, and their rows stay there.
        const AT_ONCE: usize = 16;
        let stride = self.strides[0];
        let row_length = panel.len() / steps.len().max(1);
        if stride == 1 {
            for &(offset, step) in steps {
                panel[step * row_length..][..used].copy_from_slice(&self.weights[offset + first..][..used]);
            }
            return;
        }
        for steps in steps.chunks(AT_ONCE) {
            for output in 0..used {
                let from = &self.weights[(first + output) * stride..];
                for &(offset, step) in steps {
                    panel[step * row_length + output] = from[offset];
                }
            }
        }
    }
}

/// A part of the outputs: as many as there are registers across a tile.
#[derive(Clone, Copy)]
pub(super) struct Panel {
    pub(super) weights: *const f32,
    pub(super) bias: *const f32,
    /// First output in lists that are filled up to whole registers.
    pub(super) padded_first: usize,
    pub(super) first: usize,
    /// Outputs from the first on, at most those of the panel are used.
    pub(super) used: usize,
    pub(super) vectors: usize,
}

pub(super) fn width_of(isa: Isa) -> usize {
    match isa.set() {
        Set::Portable => lanes::Portable::WIDTH,
        #[cfg(target_arch = "x86_64")]
        Set::Avx2 => lanes::Avx2::WIDTH,
        #[cfg(target_arch = "x86_64")]
        Set::Avx512 => lanes::Avx512::WIDTH,
        #[cfg(target_arch = "aarch64")]
        Set::Neon => lanes::Neon::WIDTH,
    }
}
