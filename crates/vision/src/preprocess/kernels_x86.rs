//! Packed kernels for x86-64 with AVX2 and FMA.
//!
//! A column's two taps lie within 8 bytes. A shuffle spreads them to 16-bit pairs, one pair per channel, and one
//! multiply-add blends them with 14-bit weights, exactly; rows are blended, scaled and shifted as floats. Lane 0 of a
//! register holds column `i` of a block of 8, lane 1 column `i + 4`, so that a 4x4 transpose within lanes yields
//! planes in order.

use std::arch::x86_64::*;
use std::ops::Range;

use crate::preprocess::band::Row;
use crate::preprocess::packed::{BLOCK, Packed, PackedRow};
use crate::preprocess::plan::{ONE, PackedColumns, TAP_BYTES};
use crate::preprocess::sample::Written;

/// Returns whether the CPU supports the kernels.
pub(super) fn supported() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// Writes `columns` into `row`, which has the same number of columns, at least [`BLOCK`], and three channels.
pub(super) fn write<W: Written>(
    packed: &Packed,
    source: &PackedRow<'_>,
    plan: &PackedColumns,
    columns: Range<usize>,
    row: &mut Row<'_, W>,
) {
    assert!(supported() && source.rows.iter().all(|bytes| bytes.len() >= plan.reach()));
    let offsets = &plan.offsets()[columns.clone()];
    let weights = &plan.weights()[columns];
    // SAFETY: the CPU features were checked, and the rows are long enough for every offset of the plan.
    unsafe {
        if source.weight == 0.0 {
            write_row::<1, W>(packed, source, offsets, weights, row);
        } else {
            write_row::<2, W>(packed, source, offsets, weights, row);
        }
    }
}

/// Blends `ROWS` of the two rows: 1 where the second has weight 0.
///
/// # Safety
/// Each offset plus [`TAP_BYTES`] lies within both rows.
#[target_feature(enable = "avx2,fma")]
unsafe fn write_row<const ROWS: usize, W: Written>(
    packed: &Packed,
    source: &PackedRow<'_>,
    offsets: &[u32],
    weights: &[u32],
    row: &mut Row<'_, W>,
) {
    let blend = Blend::<ROWS>::new(packed, source);
    let interleaved = row.interleaved;
    let [first, second, third] = &mut row.planes;
    for start in (0..offsets.len()).step_by(BLOCK) {
        // The last block overlaps the one before it.
        let start = start.min(offsets.len() - BLOCK);
        // SAFETY: the caller guarantees the offsets.
        let pixels = unsafe { blend.block(&offsets[start..], &weights[start..]) };
        if interleaved {
            store_interleaved(pixels, &mut first[3 * start..]);
        } else {
            store_planar(pixels, [&mut first[start..], &mut second[start..], &mut third[start..]]);
        }
    }
}

/// Values that all columns of a row share.
struct Blend<'a, const ROWS: usize> {
    rows: [&'a [u8]; 2],
    /// Scale of each channel times the row's weight times the unit of the columns' weights.
    factors: [__m256; 2],
    bias: __m256,
    shuffle: __m256i,
}

impl<'a, const ROWS: usize> Blend<'a, ROWS> {
    #[target_feature(enable = "avx2,fma")]
    fn new(packed: &Packed, source: &PackedRow<'a>) -> Self {
        let lanes = |[x, y, z]: [f32; 3]| _mm256_setr_ps(x, y, z, 0.0, x, y, z, 0.0);
        let factors = |weight: f32| lanes(packed.scale.map(|scale| scale * weight / ONE as f32));
        let shuffle = u128::from_le_bytes(packed.shuffle);
        Self {
            rows: source.rows,
            factors: [factors(1.0 - source.weight), factors(source.weight)],
            bias: lanes(packed.bias),
            shuffle: _mm256_broadcastsi128_si256(_mm_set_epi64x((shuffle >> 64) as i64, shuffle as i64)),
        }
    }

    /// Returns the values of a block: columns 0 and 4, 1 and 5, 2 and 6, 3 and 7.
    ///
    /// # Safety
    /// Each offset plus [`TAP_BYTES`] lies within both rows.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn block(&self, offsets: &[u32], weights: &[u32]) -> [__m256; 4] {
        let (offsets, weights) = (&offsets[..BLOCK], &weights[..BLOCK]);
        // SAFETY: `weights` has 8 values of 4 bytes.
        let weights = unsafe { _mm256_loadu_si256(weights.as_ptr().cast()) };
        let weights = [
            _mm256_shuffle_epi32::<0x00>(weights),
            _mm256_shuffle_epi32::<0x55>(weights),
            _mm256_shuffle_epi32::<0xaa>(weights),
            _mm256_shuffle_epi32::<0xff>(weights),
        ];
        let mut values = [self.bias; 4];
        for (index, value) in values.iter_mut().enumerate() {
            let (low, high) = (offsets[index] as usize, offsets[index + 4] as usize);
            for (row, factors) in self.rows.iter().zip(self.factors).take(ROWS) {
                // SAFETY: the caller guarantees the offsets.
                let taps = _mm256_shuffle_epi8(unsafe { load(row, low, high) }, self.shuffle);
                let levels = _mm256_cvtepi32_ps(_mm256_madd_epi16(taps, weights[index]));
                *value = _mm256_fmadd_ps(levels, factors, *value);
            }
        }
        values
    }
}

/// Loads [`TAP_BYTES`] from `low` into lane 0 and as many from `high` into lane 1. Only the first 8 bytes of each
/// matter; reading 16 saves a shuffle.
///
/// # Safety
/// Both positions plus [`TAP_BYTES`] lie within `row`.
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn load(row: &[u8], low: usize, high: usize) -> __m256i {
    debug_assert!(low.max(high) + TAP_BYTES <= row.len());
    // SAFETY: the caller guarantees the positions; the loads need no alignment.
    let lane = |at: usize| unsafe { _mm_loadu_si128(row.as_ptr().add(at).cast()) };
    _mm256_inserti128_si256::<1>(_mm256_castsi128_si256(lane(low)), lane(high))
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store_planar<W: Written>([a, b, c, d]: [__m256; 4], planes: [&mut [W]; 3]) {
    let (low_ab, low_cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
    let (high_ab, high_cd) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
    let [first, second, third] = planes;
    store(first, _mm256_shuffle_ps::<0b01_00_01_00>(low_ab, low_cd));
    store(second, _mm256_shuffle_ps::<0b11_10_11_10>(low_ab, low_cd));
    store(third, _mm256_shuffle_ps::<0b01_00_01_00>(high_ab, high_cd));
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store_interleaved<W: Written>([a, b, c, d]: [__m256; 4], out: &mut [W]) {
    // Pairs of pixels (x y z _ x y z _) are stored together: x y z x y z and two samples that the next store
    // overwrites.
    let together = _mm256_setr_epi32(0, 1, 2, 4, 5, 6, 6, 6);
    let pair = |pixels| _mm256_permutevar8x32_ps(pixels, together);
    let third = pair(_mm256_permute2f128_ps::<0x31>(a, b));
    store(&mut out[0..], pair(_mm256_permute2f128_ps::<0x20>(a, b)));
    store(&mut out[6..], pair(_mm256_permute2f128_ps::<0x20>(c, d)));
    store(&mut out[12..], third);
    // The last store ends with the block; its first two samples are the third pair's last.
    let fourth = _mm256_permutevar8x32_ps(
        _mm256_permute2f128_ps::<0x31>(c, d),
        _mm256_setr_epi32(0, 0, 0, 1, 2, 4, 5, 6),
    );
    let rest = _mm256_permutevar8x32_ps(third, _mm256_setr_epi32(4, 5, 0, 0, 0, 0, 0, 0));
    store(&mut out[16..], _mm256_blend_ps::<0b0000_0011>(fourth, rest));
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn store<W: Written>(out: &mut [W], values: __m256) {
    const { assert!(size_of::<W>() == 4) };
    let out = &mut out[..BLOCK];
    let bits = match W::ROUNDED_WITHIN {
        Some(most) => {
            let (most, least) = (_mm256_set1_ps(most), _mm256_set1_ps(-most));
            _mm256_cvtps_epi32(_mm256_min_ps(_mm256_max_ps(values, least), most))
        }
        None => _mm256_castps_si256(values),
    };
    // SAFETY: `out` has 8 samples of 4 bytes, floats or integers as in `bits`.
    unsafe { _mm256_storeu_si256(out.as_mut_ptr().cast(), bits) }
}
