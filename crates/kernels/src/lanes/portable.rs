use super::implement_lanes;

/// Four numbers in plain Rust, which the compiler translates to the target's baseline instructions (SSE2 on x86-64).
///
/// Product and sum are rounded separately: without an FMA instruction, a fused operation is a call of the C library.
#[derive(Clone, Copy)]
pub(crate) struct Portable([f32; 4]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(f32, f32) -> f32) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([op(a, e), op(b, f), op(c, g), op(d, h)])
    }

    #[inline(always)]
    fn map(self, op: impl Fn(f32) -> f32) -> Self {
        let [a, b, c, d] = self.0;
        Self([op(a), op(b), op(c), op(d)])
    }
}

/// Adding and subtracting this rounds to an integer.
const ROUNDING: f32 = 12_582_912.0;

implement_lanes! {
    Portable, width: 4, rows: 4, registers: 16,
    splat(value) = { let lanes = [value; 4]; Self(lanes) };
    load(from) = Self(from.cast::<[f32; 4]>().read_unaligned());
    store(value, to) = to.cast::<[f32; 4]>().write_unaligned(value.0);
    add(a, b) = a.zip(b, |a, b| a + b);
    sub(a, b) = a.zip(b, |a, b| a - b);
    mul(a, b) = a.zip(b, |a, b| a * b);
    div(a, b) = a.zip(b, |a, b| a / b);
    mul_add(a, b, c) = a.zip(b, |a, b| a * b).zip(c, |product, c| product + c);
    max(a, b) = a.zip(b, |a, b| if a > b { a } else { b });
    min(a, b) = a.zip(b, |a, b| if a < b { a } else { b });
    sqrt(a) = a.map(f32::sqrt);
    abs(a) = a.map(f32::abs);
    with_sign(a, sign) = a.zip(sign, f32::copysign);
    round(a) = a.map(|a| (a + ROUNDING) - ROUNDING);
    power_of_two(a) = a.map(|a| f32::from_bits((((a as i32) + 127) as u32) << 23));
    where_positive(a, gate) = a.zip(gate, |a, gate| if gate > 0.0 { a } else { 0.0 });
}
