use std::arch::x86_64::*;

use super::implement_lanes;

/// Eight numbers: AVX2 and FMA.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256);

/// Returns the mask of the first lanes.
#[inline(always)]
unsafe fn first(count: usize) -> __m256i {
    // SAFETY: the caller has AVX2; the window of eight begins at most eight before the end.
    unsafe { _mm256_loadu_si256(MASK.as_ptr().add(8 - count.min(8)).cast()) }
}

static MASK: [i32; 16] = [-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0];

const NEAREST: i32 = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;

implement_lanes! {
    Avx2, width: 8, rows: 6, registers: 16,
    @some(from, value, to, count): Self(_mm256_maskload_ps(from, first(count))), _mm256_maskstore_ps(to, first(count), value.0),
    splat(value) = Self(_mm256_set1_ps(value));
    load(from) = Self(_mm256_loadu_ps(from));
    store(value, to) = _mm256_storeu_ps(to, value.0);
    add(a, b) = Self(_mm256_add_ps(a.0, b.0));
    sub(a, b) = Self(_mm256_sub_ps(a.0, b.0));
    mul(a, b) = Self(_mm256_mul_ps(a.0, b.0));
    div(a, b) = Self(_mm256_div_ps(a.0, b.0));
    mul_add(a, b, c) = Self(_mm256_fmadd_ps(a.0, b.0, c.0));
    max(a, b) = Self(_mm256_max_ps(a.0, b.0));
    min(a, b) = Self(_mm256_min_ps(a.0, b.0));
    sqrt(a) = Self(_mm256_sqrt_ps(a.0));
    abs(a) = Self(_mm256_andnot_ps(_mm256_set1_ps(-0.0), a.0));
    with_sign(a, sign) = Self(_mm256_or_ps(a.0, _mm256_and_ps(_mm256_set1_ps(-0.0), sign.0)));
    round(a) = Self(_mm256_round_ps::<NEAREST>(a.0));
    power_of_two(a) = {
        let biased = _mm256_add_epi32(_mm256_cvtps_epi32(a.0), _mm256_set1_epi32(127));
        Self(_mm256_castsi256_ps(_mm256_slli_epi32::<23>(biased)))
    };
    where_positive(a, gate) =
        Self(_mm256_and_ps(a.0, _mm256_cmp_ps::<_CMP_GT_OQ>(gate.0, _mm256_setzero_ps())));
}
