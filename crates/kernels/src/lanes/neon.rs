use std::arch::aarch64::*;

use super::implement_lanes;

/// Four numbers: NEON of aarch64 (not tested on hardware).
#[derive(Clone, Copy)]
pub(crate) struct Neon(float32x4_t);

implement_lanes! {
    Neon, width: 4, rows: 8, registers: 32,
    splat(value) = Self(vdupq_n_f32(value));
    load(from) = Self(vld1q_f32(from));
    store(value, to) = vst1q_f32(to, value.0);
    add(a, b) = Self(vaddq_f32(a.0, b.0));
    sub(a, b) = Self(vsubq_f32(a.0, b.0));
    mul(a, b) = Self(vmulq_f32(a.0, b.0));
    div(a, b) = Self(vdivq_f32(a.0, b.0));
    mul_add(a, b, c) = Self(vfmaq_f32(c.0, a.0, b.0));
    max(a, b) = Self(vbslq_f32(vcgtq_f32(a.0, b.0), a.0, b.0));
    min(a, b) = Self(vbslq_f32(vcltq_f32(a.0, b.0), a.0, b.0));
    sqrt(a) = Self(vsqrtq_f32(a.0));
    abs(a) = Self(vabsq_f32(a.0));
    with_sign(a, sign) = Self(vbslq_f32(vdupq_n_u32(1 << 31), sign.0, a.0));
    round(a) = Self(vrndnq_f32(a.0));
    power_of_two(a) = {
        let biased = vaddq_s32(vcvtnq_s32_f32(a.0), vdupq_n_s32(127));
        Self(vreinterpretq_f32_s32(vshlq_n_s32::<23>(biased)))
    };
    where_positive(a, gate) =
        Self(vbslq_f32(vcgtq_f32(gate.0, vdupq_n_f32(0.0)), a.0, vdupq_n_f32(0.0)));
}
