use std::arch::x86_64::*;

use crate::quantized::dots::Dots;
use crate::quantized::output::Bounds;

/// Sixteen sums of products of bytes: AVX-512 VNNI.
#[derive(Clone, Copy)]
pub(in crate::quantized) struct Vnni(__m512i);

const WIDTH: usize = 16;

/// # Safety
/// The machine has AVX-512F; `scales` has sixteen numbers.
#[inline(always)]
unsafe fn scaled(sums: Vnni, scales: *const f32, bounds: &Bounds) -> __m512i {
    // SAFETY: the caller's promise.
    unsafe {
        let value = _mm512_mul_ps(_mm512_cvtepi32_ps(sums.0), _mm512_loadu_ps(scales));
        let low = _mm512_max_ps(value, _mm512_set1_ps(bounds.low));
        _mm512_cvtps_epi32(_mm512_min_ps(low, _mm512_set1_ps(bounds.high)))
    }
}

/// Returns two registers of scaled sums as 16-bit integers, with the zero point.
///
/// # Safety
/// The machine has AVX-512BW; `scales` has 32 numbers.
#[inline(always)]
unsafe fn scaled_pair(a: Vnni, b: Vnni, scales: *const f32, bounds: &Bounds) -> __m512i {
    // SAFETY: the caller's promise.
    unsafe {
        let (a, b) = (scaled(a, scales, bounds), scaled(b, scales.add(WIDTH), bounds));
        _mm512_add_epi16(_mm512_packs_epi32(a, b), _mm512_set1_epi16(bounds.zero as i16))
    }
}

/// Returns the bytes of a row in a mask, as unsigned ones.
///
/// # Safety
/// The machine has AVX-512BW; the row has the bytes in the mask.
#[inline(always)]
unsafe fn flipped(row: *const u8, mask: u64, flip: __m512i) -> __m512i {
    // SAFETY: the caller's promise.
    unsafe { _mm512_xor_si512(_mm512_maskz_loadu_epi8(mask, row.cast()), flip) }
}

/// Returns the mask of the first bytes.
#[inline(always)]
fn first(count: usize) -> u64 {
    if count >= 64 { u64::MAX } else { (1 << count) - 1 }
}

impl Dots for Vnni {
    const WIDTH: usize = WIDTH;
    const TAPS: usize = 4;
    const VECTORS: usize = 3;
    const PIXELS: usize = 4;

    #[inline(always)]
    unsafe fn splat(value: i32) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm512_set1_epi32(value) })
    }

    #[inline(always)]
    unsafe fn load(from: *const i32) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm512_loadu_si512(from.cast()) })
    }

    #[inline(always)]
    unsafe fn dot(self, x: Self, weights: Self) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm512_dpbusd_epi32(self.0, x.0, weights.0) })
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm512_add_epi32(self.0, other.0) })
    }

    #[inline(always)]
    unsafe fn add_multiple(self, factor: i32, other: Self) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm512_add_epi32(self.0, _mm512_mullo_epi32(_mm512_set1_epi32(factor), other.0)) })
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut i32) {
        // SAFETY: the trait's contract.
        unsafe { _mm512_storeu_si512(to.cast(), self.0) }
    }

    #[inline(always)]
    unsafe fn store_bytes(self, scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize) {
        // SAFETY: the trait's contract.
        unsafe {
            let value = _mm512_add_epi32(scaled(self, scales, bounds), _mm512_set1_epi32(bounds.zero));
            let bytes = _mm512_cvtepi32_epi8(value);
            if count >= WIDTH {
                _mm_storeu_si128(to.cast(), bytes);
            } else {
                _mm_mask_storeu_epi8(to.cast(), first(count) as u16, bytes);
            }
        }
    }

    #[inline(always)]
    unsafe fn sum_of_bytes(from: *const u8, count: usize) -> i32 {
        // SAFETY: the trait's contract; bytes beyond `count` are not read.
        unsafe {
            let ones = _mm512_set1_epi8(1);
            let (mut sums, mut at) = (_mm512_setzero_si512(), 0);
            while at + 64 <= count {
                sums = _mm512_dpbusd_epi32(sums, _mm512_loadu_si512(from.add(at).cast()), ones);
                at += 64;
            }
            let rest = _mm512_maskz_loadu_epi8(first(count - at), from.add(at).cast());
            _mm512_reduce_add_epi32(_mm512_dpbusd_epi32(sums, rest, ones))
        }
    }

    #[inline(always)]
    unsafe fn column(rows: &[*const u8; 4], count: usize, flip: u8, _zero: i32) -> [Self; 4] {
        // SAFETY: the trait's contract; bytes beyond `count` are not read.
        unsafe {
            let (mask, flip) = (first(count), _mm512_set1_epi8(flip as i8));
            let (a, b) = (flipped(rows[0], mask, flip), flipped(rows[1], mask, flip));
            let (c, d) = (flipped(rows[2], mask, flip), flipped(rows[3], mask, flip));
            let (low, high) = (_mm512_unpacklo_epi8(a, b), _mm512_unpackhi_epi8(a, b));
            let (next_low, next_high) = (_mm512_unpacklo_epi8(c, d), _mm512_unpackhi_epi8(c, d));
            [
                Self(_mm512_unpacklo_epi16(low, next_low)),
                Self(_mm512_unpackhi_epi16(low, next_low)),
                Self(_mm512_unpacklo_epi16(high, next_high)),
                Self(_mm512_unpackhi_epi16(high, next_high)),
            ]
        }
    }

    #[inline(always)]
    unsafe fn store_column(sums: &[Self; 4], scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize) {
        // SAFETY: the trait's contract.
        unsafe {
            let low = scaled_pair(sums[0], sums[1], scales, bounds);
            let high = scaled_pair(sums[2], sums[3], scales.add(2 * WIDTH), bounds);
            let bytes =
                if bounds.is_signed { _mm512_packs_epi16(low, high) } else { _mm512_packus_epi16(low, high) };
            _mm512_mask_storeu_epi8(to.cast(), first(count), bytes);
        }
    }

    fn channel(register: usize, lane: usize) -> usize {
        16 * (lane / 4) + 4 * register + lane % 4
    }
}
