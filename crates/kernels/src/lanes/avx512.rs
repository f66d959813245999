use std::arch::x86_64::*;

use super::implement_lanes;

/// Sixteen numbers: AVX-512F only, so that sign bits are set by integer instructions.
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m512);

/// Returns the mask of the first lanes.
#[inline(always)]
fn first(count: usize) -> __mmask16 {
    ((1_u32 << count) - 1) as __mmask16
}

const NEAREST: i32 = _MM_FROUND_TO_NEAREST_INT;

implement_lanes! {
    Avx512, width: 16, rows: 8, registers: 32,
    @some(from, value, to, count): Self(_mm512_maskz_loadu_ps(first(count), from)), _mm512_mask_storeu_ps(to, first(count), value.0),
    splat(value) = Self(_mm512_set1_ps(value));
    load(from) = Self(_mm512_loadu_ps(from));
    store(value, to) = _mm512_storeu_ps(to, value.0);
    add(a, b) = Self(_mm512_add_ps(a.0, b.0));
    sub(a, b) = Self(_mm512_sub_ps(a.0, b.0));
    mul(a, b) = Self(_mm512_mul_ps(a.0, b.0));
    div(a, b) = Self(_mm512_div_ps(a.0, b.0));
    mul_add(a, b, c) = Self(_mm512_fmadd_ps(a.0, b.0, c.0));
    max(a, b) = Self(_mm512_max_ps(a.0, b.0));
    min(a, b) = Self(_mm512_min_ps(a.0, b.0));
    sqrt(a) = Self(_mm512_sqrt_ps(a.0));
    abs(a) = Self(_mm512_abs_ps(a.0));
    with_sign(a, sign) = {
        let bit = _mm512_and_si512(_mm512_castps_si512(sign.0), _mm512_set1_epi32(i32::MIN));
        Self(_mm512_castsi512_ps(_mm512_or_si512(_mm512_castps_si512(a.0), bit)))
    };
    round(a) = Self(_mm512_roundscale_ps::<NEAREST>(a.0));
    power_of_two(a) = {
        let biased = _mm512_add_epi32(_mm512_cvtps_epi32(a.0), _mm512_set1_epi32(127));
        Self(_mm512_castsi512_ps(_mm512_slli_epi32::<23>(biased)))
    };
    where_positive(a, gate) = {
        let positive = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(gate.0, _mm512_setzero_ps());
        Self(_mm512_maskz_mov_ps(positive, a.0))
    };
}
