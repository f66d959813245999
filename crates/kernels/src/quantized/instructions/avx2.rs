use std::arch::x86_64::*;

use crate::quantized::dots::Dots;
use crate::quantized::output::Bounds;

/// Eight sums of products of 16-bit integers: AVX2. (Its instruction for bytes saturates.)
#[derive(Clone, Copy)]
pub(in crate::quantized) struct Avx2(__m256i);

const WIDTH: usize = 8;

/// # Safety
/// The machine has AVX2; `scales` has eight numbers.
#[inline(always)]
unsafe fn scaled(sums: Avx2, scales: *const f32, bounds: &Bounds) -> __m256i {
    // SAFETY: the caller's promise.
    unsafe {
        let value = _mm256_mul_ps(_mm256_cvtepi32_ps(sums.0), _mm256_loadu_ps(scales));
        let low = _mm256_max_ps(value, _mm256_set1_ps(bounds.low));
        _mm256_cvtps_epi32(_mm256_min_ps(low, _mm256_set1_ps(bounds.high)))
    }
}

/// Returns two registers of scaled sums as 16-bit integers, with the zero point.
///
/// # Safety
/// The machine has AVX2; `scales` has sixteen numbers.
#[inline(always)]
unsafe fn scaled_pair(a: Avx2, b: Avx2, scales: *const f32, bounds: &Bounds) -> __m256i {
    // SAFETY: the caller's promise.
    unsafe {
        let (a, b) = (scaled(a, scales, bounds), scaled(b, scales.add(WIDTH), bounds));
        _mm256_add_epi16(_mm256_packs_epi32(a, b), _mm256_set1_epi16(bounds.zero as i16))
    }
}

/// Returns sixteen bytes as 16-bit integers without the zero point.
///
/// # Safety
/// The machine has AVX2; the row has sixteen bytes.
#[inline(always)]
unsafe fn wide(row: *const u8, flip: u8, zero: i32) -> __m256i {
    // SAFETY: the caller's promise.
    unsafe {
        let bytes = _mm_xor_si128(_mm_loadu_si128(row.cast()), _mm_set1_epi8(flip as i8));
        _mm256_sub_epi16(_mm256_cvtepu8_epi16(bytes), _mm256_set1_epi16(zero as i16))
    }
}

impl Dots for Avx2 {
    const WIDTH: usize = WIDTH;
    const TAPS: usize = 2;
    const VECTORS: usize = 2;
    const PIXELS: usize = 2;

    #[inline(always)]
    unsafe fn splat(value: i32) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm256_set1_epi32(value) })
    }

    #[inline(always)]
    unsafe fn load(from: *const i32) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm256_loadu_si256(from.cast()) })
    }

    #[inline(always)]
    unsafe fn dot(self, x: Self, weights: Self) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm256_add_epi32(self.0, _mm256_madd_epi16(x.0, weights.0)) })
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm256_add_epi32(self.0, other.0) })
    }

    #[inline(always)]
    unsafe fn add_multiple(self, factor: i32, other: Self) -> Self {
        // SAFETY: the trait's contract.
        Self(unsafe { _mm256_add_epi32(self.0, _mm256_mullo_epi32(_mm256_set1_epi32(factor), other.0)) })
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut i32) {
        // SAFETY: the trait's contract.
        unsafe { _mm256_storeu_si256(to.cast(), self.0) }
    }

    #[inline(always)]
    unsafe fn store_bytes(self, scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize) {
        // SAFETY: the trait's contract.
        unsafe {
            let value = _mm256_add_epi32(scaled(self, scales, bounds), _mm256_set1_epi32(bounds.zero));
            // The low byte of each word, which is within the range of a byte.
            let order = _mm256_set1_epi32(0x0c08_0400);
            let bytes = _mm256_shuffle_epi8(value, order);
            let low = _mm256_cvtsi256_si32(bytes) as u32;
            let high = _mm_cvtsi128_si32(_mm256_extracti128_si256::<1>(bytes)) as u32;
            let all = (u64::from(low) | (u64::from(high) << 32)).to_le_bytes();
            if count >= WIDTH {
                to.cast::<[u8; WIDTH]>().write_unaligned(all);
            } else {
                to.copy_from_nonoverlapping(all.as_ptr(), count);
            }
        }
    }

    #[inline(always)]
    unsafe fn column(rows: &[*const u8; 4], count: usize, flip: u8, zero: i32) -> [Self; 4] {
        // SAFETY: the trait's contract; rows that are too short are copied first.
        unsafe {
            let mut few = [[0_u8; 32]; 2];
            let mut rows = [rows[0], rows[1]];
            if count < 32 {
                for (few, row) in few.iter_mut().zip(&mut rows) {
                    few.as_mut_ptr().copy_from_nonoverlapping(*row, count);
                    *row = few.as_ptr();
                }
            }
            let (a, b) = (wide(rows[0], flip, zero), wide(rows[1], flip, zero));
            let (c, d) = (wide(rows[0].add(16), flip, zero), wide(rows[1].add(16), flip, zero));
            [
                Self(_mm256_unpacklo_epi16(a, b)),
                Self(_mm256_unpackhi_epi16(a, b)),
                Self(_mm256_unpacklo_epi16(c, d)),
                Self(_mm256_unpackhi_epi16(c, d)),
            ]
        }
    }

    #[inline(always)]
    unsafe fn store_column(sums: &[Self; 4], scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize) {
        // SAFETY: the trait's contract.
        unsafe {
            let first = scaled_pair(sums[0], sums[1], scales, bounds);
            let second = scaled_pair(sums[2], sums[3], scales.add(2 * WIDTH), bounds);
            let packed = if bounds.is_signed {
                _mm256_packs_epi16(first, second)
            } else {
                _mm256_packus_epi16(first, second)
            };
            let bytes = _mm256_permute4x64_epi64::<0b11_01_10_00>(packed);
            if count >= 32 {
                _mm256_storeu_si256(to.cast(), bytes);
            } else {
                let mut few = [0_u8; 32];
                _mm256_storeu_si256(few.as_mut_ptr().cast(), bytes);
                to.copy_from_nonoverlapping(few.as_ptr(), count);
            }
        }
    }

    fn channel(register: usize, lane: usize) -> usize {
        16 * (register / 2) + 8 * (lane / 4) + 4 * (register % 2) + lane % 4
    }
}
