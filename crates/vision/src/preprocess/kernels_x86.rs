//! Packed kernels for x86-64 with AVX2 and FMA.
//!
//! A column's two taps lie within 8 bytes. A shuffle spreads them to 16-bit pairs, one pair a channel, and one
//! multiply-add blends them with 14-bit weights, exactly; rows are blended as floats. Lane 0 of a register holds
//! column `i` of a block of 8, lane 1 column `i + 4`, so that a 4x4 transpose within lanes gives planes in order.

use std::arch::x86_64::*;
use std::ops::Range;

use crate::preprocess::band::Row;
use crate::preprocess::packed::{BLOCK, Packed, PackedRow};
use crate::preprocess::plan::{ONE, PackedColumns, TAP_BYTES};

/// Whether the kernels can run here.
pub(super) fn supported() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// Writes `columns` into `row`, which has as many, at least [`BLOCK`], of three channels.
pub(super) fn write(
    packed: &Packed,
    source: &PackedRow<'_>,
    plan: &PackedColumns,
    columns: Range<usize>,
    row: &mut Row<'_, f32>,
) {
    assert!(supported() && source.rows.iter().all(|bytes| bytes.len() >= plan.reach()));
    // SAFETY: the features were just asked for.
    unsafe {
        if row.interleaved {
            write_interleaved(packed, source, plan, columns, row.planes[0]);
        } else {
            write_planar(packed, source, plan, columns, &mut row.planes);
        }
    }
}

/// Where the blocks of `count` columns begin: the last one reaches back over the one before it.
fn blocks(count: usize) -> impl Iterator<Item = usize> {
    (0..count).step_by(BLOCK).map(move |start| start.min(count - BLOCK))
}

#[target_feature(enable = "avx2,fma")]
fn write_planar(
    packed: &Packed,
    source: &PackedRow<'_>,
    plan: &PackedColumns,
    columns: Range<usize>,
    planes: &mut [&mut [f32]; 3],
) {
    let blend = Blend::new(packed, source);
    let scale = packed.scale.map(|value| _mm256_set1_ps(value));
    let bias = packed.bias.map(|value| _mm256_set1_ps(value));
    let offsets = &plan.offsets()[columns.clone()];
    let weights = &plan.weights()[columns];
    let [first, second, third] = planes;
    for start in blocks(offsets.len()) {
        let block = start..start + BLOCK;
        let [a, b, c, d] = blend.block(&offsets[block.clone()], &weights[block.clone()]);
        let (low_ab, low_cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (high_ab, high_cd) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        let channels = [
            _mm256_shuffle_ps::<0b01_00_01_00>(low_ab, low_cd),
            _mm256_shuffle_ps::<0b11_10_11_10>(low_ab, low_cd),
            _mm256_shuffle_ps::<0b01_00_01_00>(high_ab, high_cd),
        ];
        store(&mut first[block.clone()], _mm256_fmadd_ps(channels[0], scale[0], bias[0]));
        store(&mut second[block.clone()], _mm256_fmadd_ps(channels[1], scale[1], bias[1]));
        store(&mut third[block], _mm256_fmadd_ps(channels[2], scale[2], bias[2]));
    }
}

#[target_feature(enable = "avx2,fma")]
fn write_interleaved(
    packed: &Packed,
    source: &PackedRow<'_>,
    plan: &PackedColumns,
    columns: Range<usize>,
    out: &mut [f32],
) {
    let blend = Blend::new(packed, source);
    let lanes = |[x, y, z]: [f32; 3]| _mm256_setr_ps(x, y, z, 0.0, x, y, z, 0.0);
    let (scale, bias) = (lanes(packed.scale), lanes(packed.bias));
    let offsets = &plan.offsets()[columns.clone()];
    let weights = &plan.weights()[columns];
    // Gathers pixels (x y z _ x' y' z' _) at the front, or so that they end with the register.
    let front = _mm256_setr_epi32(0, 1, 2, 4, 5, 6, 7, 7);
    let back = _mm256_setr_epi32(7, 7, 0, 1, 2, 4, 5, 6);
    for start in blocks(offsets.len()) {
        let block = start..start + BLOCK;
        let pixels = blend.block(&offsets[block.clone()], &weights[block]);
        let [a, b, c, d] = pixels.map(|pixel| _mm256_fmadd_ps(pixel, scale, bias));
        let pairs = [
            _mm256_permute2f128_ps::<0x20>(a, b),
            _mm256_permute2f128_ps::<0x20>(c, d),
            _mm256_permute2f128_ps::<0x31>(a, b),
            _mm256_permute2f128_ps::<0x31>(c, d),
        ];
        // Two floats too many a store, which the next one replaces; the last is aligned to the block's end.
        let out = &mut out[3 * start..3 * (start + BLOCK)];
        store(&mut out[0..8], _mm256_permutevar8x32_ps(pairs[0], front));
        store(&mut out[6..14], _mm256_permutevar8x32_ps(pairs[1], front));
        let third = _mm256_permutevar8x32_ps(pairs[2], front);
        let fourth = _mm256_permutevar8x32_ps(pairs[3], back);
        store(&mut out[12..20], third);
        // Its first two floats are the end of the third pair.
        let tail = _mm256_permutevar8x32_ps(third, _mm256_setr_epi32(4, 5, 0, 0, 0, 0, 0, 0));
        store(&mut out[16..24], _mm256_blend_ps::<0b0000_0011>(fourth, tail));
    }
}

/// The blending of two rows.
struct Blend<'a> {
    rows: [&'a [u8]; 2],
    weights: [__m256; 2],
    shuffle: __m256i,
}

impl<'a> Blend<'a> {
    #[target_feature(enable = "avx2,fma")]
    fn new(packed: &Packed, source: &PackedRow<'a>) -> Self {
        let unit = 1.0 / ONE as f32;
        let shuffle = u128::from_le_bytes(packed.shuffle);
        Self {
            rows: source.rows,
            weights: [_mm256_set1_ps((1.0 - source.weight) * unit), _mm256_set1_ps(source.weight * unit)],
            shuffle: _mm256_broadcastsi128_si256(_mm_set_epi64x((shuffle >> 64) as i64, shuffle as i64)),
        }
    }

    /// Four registers of levels: columns 0 and 4, 1 and 5, 2 and 6, 3 and 7 of a block.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn block(&self, offsets: &[u32], weights: &[u32]) -> [__m256; 4] {
        // SAFETY: `weights` has 8 of 4 bytes.
        let weights = unsafe { _mm256_loadu_si256(weights[..BLOCK].as_ptr().cast()) };
        let weights = [
            _mm256_shuffle_epi32::<0x00>(weights),
            _mm256_shuffle_epi32::<0x55>(weights),
            _mm256_shuffle_epi32::<0xaa>(weights),
            _mm256_shuffle_epi32::<0xff>(weights),
        ];
        let mut levels = [_mm256_setzero_ps(); 4];
        for (index, level) in levels.iter_mut().enumerate() {
            let (low, high) = (offsets[index] as usize, offsets[index + 4] as usize);
            let [upper, lower] = self.rows.map(|row| {
                // SAFETY: `write` checked that the rows are as long as `reach`, which covers `TAP_BYTES` from
                // every offset of the plan.
                let taps = unsafe { load(row, low, high) };
                let taps = _mm256_shuffle_epi8(taps, self.shuffle);
                _mm256_cvtepi32_ps(_mm256_madd_epi16(taps, weights[index]))
            });
            *level = _mm256_fmadd_ps(lower, self.weights[1], _mm256_mul_ps(upper, self.weights[0]));
        }
        levels
    }
}

/// 8 bytes from `low` in each half of lane 0 and 8 bytes from `high` in each half of lane 1.
///
/// # Safety
/// Both positions plus [`TAP_BYTES`] lie within `row`.
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn load(row: &[u8], low: usize, high: usize) -> __m256i {
    debug_assert!(low.max(high) + TAP_BYTES <= row.len());
    // SAFETY: as the caller promises; the reads need no alignment.
    let (low, high) = unsafe {
        (
            row.as_ptr().add(low).cast::<i64>().read_unaligned(),
            row.as_ptr().add(high).cast::<i64>().read_unaligned(),
        )
    };
    _mm256_blend_epi32::<0xf0>(_mm256_set1_epi64x(low), _mm256_set1_epi64x(high))
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store(out: &mut [f32], values: __m256) {
    let out = &mut out[..BLOCK];
    // SAFETY: `out` has 8 floats.
    unsafe { _mm256_storeu_ps(out.as_mut_ptr(), values) }
}
