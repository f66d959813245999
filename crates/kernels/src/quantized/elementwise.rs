//! Quantisation, dequantisation and sums of tensors of bytes.

use super::output::{Bounds, ByteOutput, ByteZero};
use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;
use crate::pool::Pieces;

/// Bytes that a piece of work has.
const PIECE: usize = 1 << 15;

/// Quantises numbers: `round(x / scale) + zero`, ties to even, within the bounds. NaN becomes the lowest byte.
///
/// # Panics
/// When the lengths differ.
pub fn quantize(compute: &Compute, x: &[f32], scale: f32, output: ByteOutput, y: &mut [u8]) {
    assert_eq!(x.len(), y.len(), "as many bytes as numbers");
    let bounds = output.bounds();
    let isa = compute.isa();
    compute.pool().run_on_pieces(y, PIECE, |index, y| {
        let x = &x[index * PIECE..][..y.len()];
        // SAFETY: the slices are equally long.
        unsafe { dispatch_quantize(isa, x, scale, &bounds, y) }
    });
}

for_every_isa!(fn dispatch_quantize = quantize_piece(x: &[f32], scale: f32, bounds: &Bounds, y: &mut [u8]));

#[inline(always)]
unsafe fn quantize_piece<V: Lanes>(x: &[f32], scale: f32, bounds: &Bounds, y: &mut [u8]) {
    for (y, &x) in y.iter_mut().zip(x) {
        // SAFETY: passed on.
        *y = unsafe { rounded(x / scale, bounds) };
    }
}

/// Rounds a number relative to the zero point.
///
/// # Safety
/// The bounds are finite, at most 2^24.
#[inline(always)]
unsafe fn rounded(value: f32, bounds: &Bounds) -> u8 {
    let value = value.max(bounds.low).min(bounds.high).round_ties_even();
    // SAFETY: bounds are bytes, and `max` and `min` return one of them where the value is NaN.
    let whole: i32 = unsafe { value.to_int_unchecked() };
    (whole + bounds.zero) as u8
}

/// Dequantises bytes: `(x - zero) * scale`.
///
/// # Panics
/// When the lengths differ.
pub fn dequantize(compute: &Compute, x: &[u8], scale: f32, zero: ByteZero, y: &mut [f32]) {
    assert_eq!(x.len(), y.len(), "as many numbers as bytes");
    let isa = compute.isa();
    compute.pool().run_on_pieces(y, PIECE, |index, y| {
        let x = &x[index * PIECE..][..y.len()];
        // SAFETY: the slices are equally long.
        unsafe { dispatch_dequantize(isa, x, scale, zero, y) }
    });
}

for_every_isa!(fn dispatch_dequantize = dequantize_piece(x: &[u8], scale: f32, zero: ByteZero, y: &mut [f32]));

#[inline(always)]
unsafe fn dequantize_piece<V: Lanes>(x: &[u8], scale: f32, zero: ByteZero, y: &mut [f32]) {
    let (flip, zero) = (zero.flip(), zero.unsigned());
    for (y, &x) in y.iter_mut().zip(x) {
        *y = (i32::from(x ^ flip) - zero) as f32 * scale;
    }
}

/// A sum of two tensors of bytes, with quantisations of their own.
#[derive(Debug, Clone, Copy)]
pub struct ByteSum {
    /// Quantisation of the terms, and their scales divided by that of the sum.
    pub terms: [(ByteZero, f32); 2],
    /// Quantisation of the sum.
    pub output: ByteOutput,
}

impl ByteSum {
    /// Writes the sum into `y`: `round((fixed + a * ratio_a) + b * ratio_b)`, where `fixed` has all zero points, as ONNX Runtime does.
    ///
    /// # Panics
    /// When the lengths differ.
    pub fn run(&self, compute: &Compute, [a, b]: [&[u8]; 2], y: &mut [u8]) {
        assert!(a.len() == y.len() && b.len() == y.len(), "terms and sum of one shape");
        let isa = compute.isa();
        compute.pool().run_on_pieces(y, PIECE, |index, y| {
            let terms = [a, b].map(|x| &x[index * PIECE..][..y.len()]);
            // SAFETY: the slices are equally long.
            unsafe { dispatch_sum(isa, self, terms, y) }
        });
    }
}

for_every_isa!(fn dispatch_sum = sum_piece(sum: &ByteSum, terms: [&[u8]; 2], y: &mut [u8]));

#[inline(always)]
unsafe fn sum_piece<V: Lanes>(sum: &ByteSum, [a, b]: [&[u8]; 2], y: &mut [u8]) {
    let [(a_zero, a_ratio), (b_zero, b_ratio)] = sum.terms;
    let output = sum.output;
    let fixed = output.zero.zero as f32 - (a_ratio * a_zero.zero as f32 + b_ratio * b_zero.zero as f32);
    let (a_flip, b_flip) = (a_zero.flip(), b_zero.flip());
    let (a_shift, b_shift) = (i32::from(a_flip), i32::from(b_flip));
    let bounds = Bounds {
        low: output.low as f32,
        high: output.high as f32,
        zero: 0,
        is_signed: output.zero.is_signed,
    };
    for ((y, &a), &b) in y.iter_mut().zip(a).zip(b) {
        let a = (i32::from(a ^ a_flip) - a_shift) as f32;
        let b = (i32::from(b ^ b_flip) - b_shift) as f32;
        // SAFETY: passed on.
        *y = unsafe { rounded((fixed + a * a_ratio) + b * b_ratio, &bounds) };
    }
}

/// Adds rows of bytes, as many as `x` has, to sums, one for each byte of a row.
///
/// # Panics
/// When the sums are no row.
pub fn add_byte_rows(compute: &Compute, x: &[u8], is_signed: bool, sums: &mut [i32]) {
    assert!(!sums.is_empty() && x.len().is_multiple_of(sums.len()), "whole rows");
    let (isa, row) = (compute.isa(), sums.len());
    const COLUMNS: usize = 256;
    let sums = Pieces::new(sums, COLUMNS);
    compute.pool().run(row.div_ceil(COLUMNS), |index| {
        // SAFETY: each piece is taken once; rows are whole.
        unsafe { dispatch_rows(isa, x, row, index * COLUMNS, is_signed, sums.get(index)) }
    });
}

for_every_isa!(fn dispatch_rows = add_rows(x: &[u8], row: usize, first: usize, is_signed: bool, sums: &mut [i32]));

#[inline(always)]
unsafe fn add_rows<V: Lanes>(x: &[u8], row: usize, first: usize, is_signed: bool, sums: &mut [i32]) {
    for x in x.chunks_exact(row) {
        let x = &x[first..][..sums.len()];
        if is_signed {
            sums.iter_mut().zip(x).for_each(|(sum, &x)| *sum += i32::from(x as i8));
        } else {
            sums.iter_mut().zip(x).for_each(|(sum, &x)| *sum += i32::from(x));
        }
    }
}
