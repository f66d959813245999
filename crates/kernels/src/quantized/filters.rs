//! Weights of bytes in the order in which the inner loop reads them.

use super::instructions::Instructions;
use super::output::ByteZero;
use crate::compute::Compute;

/// Weights of the shape `[outputs, channels, height, width]` (depthwise: one channel) as a quantised model has them.
#[derive(Debug, Clone, Copy)]
pub struct ByteWeights<'a> {
    /// Weights, of signed bytes as their bits.
    pub bytes: &'a [u8],
    /// Whether the bytes are signed.
    pub is_signed: bool,
    /// The byte that stands for 0, one for all outputs or one for each.
    pub zeros: &'a [i32],
    /// Number of outputs.
    pub outputs: usize,
    /// Channels of each output.
    pub channels: usize,
    /// Height and width of the kernel.
    pub kernel: [usize; 2],
    /// Bias in units of the sums, one for each output, or empty.
    pub bias: &'a [i32],
    /// Factors from the sums to bytes of the output, one for all outputs or one for each.
    pub scales: &'a [f32],
}

impl ByteWeights<'_> {
    pub(super) fn check(&self) {
        let taps = self.kernel[0] * self.kernel[1];
        assert_eq!(
            self.bytes.len(),
            self.outputs * self.channels * taps,
            "the weights must have the stated shape"
        );
        let each = |length: usize| length == 1 || length == self.outputs;
        assert!(
            each(self.zeros.len()) && each(self.scales.len()),
            "one zero point and scale for all or each"
        );
        assert!(self.bias.is_empty() || self.bias.len() == self.outputs, "one bias per output");
    }

    pub(super) fn zero(&self, output: usize) -> i32 {
        if self.zeros.len() == 1 { self.zeros[0] } else { self.zeros[output] }
    }

    pub(super) fn scale(&self, output: usize) -> f32 {
        if self.scales.len() == 1 { self.scales[0] } else { self.scales[output] }
    }

    /// Returns a weight as the model has it.
    pub(super) fn number(&self, index: usize) -> i32 {
        let byte = self.bytes[index];
        if self.is_signed { i32::from(byte as i8) } else { i32::from(byte) }
    }
}

/// Packed weights and bias of a convolution or product, for one instruction set and one zero point of the input.
pub struct ByteFilters {
    pub(super) instructions: Instructions,
    pub(super) input: ByteZero,
    pub(super) outputs: usize,
    pub(super) channels: usize,
    pub(super) kernel: [usize; 2],
    /// Registers per panel.
    pub(super) vectors: usize,
    /// Words of an input row.
    pub(super) words: usize,
    panels: Vec<i32>,
    /// What is added to the sums; these lists are filled up to whole registers.
    constants: Vec<i32>,
    /// What the sum of an input row is multiplied by, and added.
    corrections: Vec<i32>,
    pub(super) has_corrections: bool,
    scales: Vec<f32>,
}

impl std::fmt::Debug for ByteFilters {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "ByteFilters({}x{}x{:?})", self.outputs, self.channels, self.kernel)
    }
}

impl ByteFilters {
    /// Packs weights for an input of that zero point.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn new(compute: &Compute, weights: &ByteWeights<'_>, input: ByteZero) -> Self {
        weights.check();
        let instructions = Instructions::of(compute.isa());
        let (width, taps) = (instructions.width(), instructions.taps());
        let depth = weights.channels * weights.kernel[0] * weights.kernel[1];
        let (words, blocks) = (depth.div_ceil(taps), weights.outputs.div_ceil(width));
        let most = instructions.vectors();
        let vectors =
            if most > 2 && (blocks.is_multiple_of(3) || blocks > 6) { 3 } else { 2 }.min(blocks.max(1));
        let mut filters = Self {
            instructions,
            input,
            outputs: weights.outputs,
            channels: weights.channels,
            kernel: weights.kernel,
            vectors,
            words,
            panels: vec![0; blocks * width * words],
            constants: vec![0; blocks * width],
            corrections: vec![0; blocks * width],
            has_corrections: false,
            scales: vec![0.0; blocks * width],
        };
        let mut row = Vec::with_capacity(words * taps);
        for output in 0..weights.outputs {
            filters.pack(weights, output, &mut row);
        }
        filters.has_corrections = filters.corrections.iter().any(|&correction| correction != 0);
        filters
    }

    /// Packs the weights of an output; `row` is memory for them. Bytes are `w - shift` with a shift of 128 where they are not signed.
    fn pack(&mut self, weights: &ByteWeights<'_>, output: usize, row: &mut Vec<u8>) {
        let (width, taps) = (self.instructions.width(), self.instructions.taps());
        let zero = weights.zero(output);
        let shift = if weights.is_signed { 0 } else { 128 };
        let first = output / (width * self.vectors) * self.vectors * width;
        let across = (self.vectors * width).min(self.constants.len() - first);
        let panel = &mut self.panels[first * self.words..][..across * self.words];
        let pixels = weights.kernel[0] * weights.kernel[1];
        let length = weights.channels * pixels;
        let from = &weights.bytes[output * length..][..length];
        row.clear();
        row.extend((0..pixels).flat_map(|tap| from.iter().skip(tap).step_by(pixels)));
        let lowest = if weights.is_signed { 128 } else { 0 };
        let number = |&byte: &u8| i32::from(byte ^ lowest) - i32::from(lowest) - zero;
        let sum = row.iter().map(number).fold(0, i32::wrapping_add);
        let words = panel.iter_mut().skip(output - first).step_by(across);
        if taps == 4 {
            let shift = shift as u8;
            row.resize(4 * self.words, shift);
            for (word, bytes) in words.zip(row.as_chunks().0) {
                *word = i32::from_le_bytes(bytes.map(|byte| byte ^ shift));
            }
        } else {
            for (word, pair) in words.zip(row.chunks(2)) {
                let second = pair.get(1).map_or(0, number);
                *word = (number(&pair[0]) & 0xffff) | (second << 16);
            }
        }
        let mut constant = weights.bias.get(output).copied().unwrap_or(0);
        if self.instructions.is_bytes() {
            // sum((x - zx) (w - zw)) = sum(x (w - shift)) + (shift - zw) sum(x) - zx sum(w - zw)
            constant = constant.wrapping_sub(self.input.unsigned().wrapping_mul(sum));
            self.corrections[output] = shift - zero;
        }
        self.constants[output] = constant;
        self.scales[output] = weights.scale(output);
    }

    /// Returns the bytes of the packed weights.
    pub fn bytes(&self) -> usize {
        size_of::<i32>() * self.panels.len()
    }

    pub(super) fn panel_count(&self) -> usize {
        (self.constants.len() / self.instructions.width()).div_ceil(self.vectors)
    }

    /// Returns a panel of as many outputs as there are registers across a tile.
    pub(super) fn panel(&self, index: usize) -> Panel {
        let width = self.instructions.width();
        let first = index * self.vectors * width;
        Panel {
            weights: self.panels[first * self.words..].as_ptr(),
            constants: self.constants[first..].as_ptr(),
            corrections: self.corrections[first..].as_ptr(),
            scales: self.scales[first..].as_ptr(),
            first,
            used: self.outputs - first,
            vectors: self.vectors.min((self.constants.len() - first) / width),
        }
    }
}

/// A part of the outputs.
#[derive(Clone, Copy)]
pub(super) struct Panel {
    pub(super) weights: *const i32,
    pub(super) constants: *const i32,
    pub(super) corrections: *const i32,
    pub(super) scales: *const f32,
    pub(super) first: usize,
    /// Outputs from the first on, at most those of the panel are used.
    pub(super) used: usize,
    pub(super) vectors: usize,
}
