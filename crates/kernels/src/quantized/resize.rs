//! Bilinear resizing of tensors of bytes with channels last.

use super::output::ByteZero;
use crate::aligned::{PATCHES, with_buffer};
use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// Bits of a weight.
const BITS: u32 = 10;

/// A bilinear resizing of height and width, with weights of 10 bits.
#[derive(Debug, Clone)]
pub struct ByteResize {
    /// For each row of the output two rows of the input, and the weight of the second, 0 to 1024.
    pub rows: Vec<([usize; 2], i32)>,
    /// The same for each column.
    pub columns: Vec<([usize; 2], i32)>,
    /// Height and width of the input.
    pub input: [usize; 2],
    /// Number of channels.
    pub channels: usize,
    /// Signedness of the bytes.
    pub zero: ByteZero,
}

impl ByteResize {
    /// Writes the interpolated image into `y`; fractions are cut off, as by ONNX Runtime.
    ///
    /// # Panics
    /// When the slices do not have the stated shapes, or rows and columns lie outside of the input.
    pub fn run(&self, compute: &Compute, x: &[u8], y: &mut [u8]) {
        let Self { rows, columns, input: [height, width], channels, .. } = self;
        let (image, row) = (height * width * channels, columns.len() * channels);
        assert_eq!(y.len() * image, x.len() * rows.len() * row, "the sizes of input and output");
        assert!(rows.iter().all(|([a, b], _)| a < height && b < height), "rows outside of the input");
        assert!(columns.iter().all(|([a, b], _)| a < width && b < width), "columns outside of the input");
        if y.is_empty() {
            return;
        }
        let isa = compute.isa();
        compute.pool().run_on_pieces(y, row, |index, y| {
            let x = &x[index / rows.len() * image..][..image];
            with_buffer(&PATCHES, width * channels, |buffer| {
                let line = crate::arena::integers(buffer);
                // SAFETY: nothing is required but the instructions.
                unsafe { dispatch_row(isa, self, rows[index % rows.len()], x, line, y) }
            });
        });
    }
}

for_every_isa!(fn dispatch_row = row(
    resize: &ByteResize,
    at: ([usize; 2], i32),
    x: &[u8],
    line: &mut [i32],
    y: &mut [u8],
));

/// Blends two rows of the input, then pairs of its pixels.
#[inline(always)]
unsafe fn row<V: Lanes>(
    resize: &ByteResize,
    ([top, bottom], weight): ([usize; 2], i32),
    x: &[u8],
    line: &mut [i32],
    y: &mut [u8],
) {
    let (channels, flip) = (resize.channels, resize.zero.flip());
    let length = resize.input[1] * channels;
    let (above, below) = (&x[top * length..][..length], &x[bottom * length..][..length]);
    for ((line, &a), &b) in line.iter_mut().zip(above).zip(below) {
        *line = i32::from(a ^ flip) * ((1 << BITS) - weight) + i32::from(b ^ flip) * weight;
    }
    for (y, &([left, right], weight)) in y.chunks_exact_mut(channels).zip(&resize.columns) {
        let (a, b) = (&line[left * channels..][..channels], &line[right * channels..][..channels]);
        for ((y, &a), &b) in y.iter_mut().zip(a).zip(b) {
            *y = ((a * ((1 << BITS) - weight) + b * weight) >> (2 * BITS)) as u8 ^ flip;
        }
    }
}
