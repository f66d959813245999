//! Half precision (IEEE 754 binary16).

/// Converts the bits of a `float16` to an `f32`, exactly.
pub fn float_from_half(half: u16) -> f32 {
    let sign = u32::from(half & 0x8000) << 16;
    let exponent = u32::from(half >> 10 & 0x1f);
    let fraction = u32::from(half & 0x3ff);
    match exponent {
        // Zero and subnormals are multiples of 2^-24.
        0 => f32::from_bits(sign | (fraction as f32 * f32::from_bits(0x3380_0000)).to_bits()),
        31 => f32::from_bits(sign | 0x7f80_0000 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

/// Converts an `f32` to the bits of the nearest `float16`, ties to even.
pub fn half_from_float(value: f32) -> u16 {
    let bits = value.to_bits();
    let sign = (bits >> 16 & 0x8000) as u16;
    let magnitude = f32::from_bits(bits & 0x7fff_ffff);
    if magnitude < 6.103_515_6e-5 {
        // Below the smallest normal number the steps are equal: adding 0.5 aligns the steps of the sum with them and
        // rounds.
        return sign | ((magnitude + 0.5).to_bits() - 0.5_f32.to_bits()) as u16;
    }
    let bits = bits & 0x7fff_ffff;
    let rounded = bits + 0xfff + (bits >> 13 & 1);
    let half = (rounded >> 13) - ((127 - 15) << 10);
    sign | if magnitude.is_nan() { 0x7e00 } else { half.min(0x7c00) as u16 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_precision_widens_exactly() {
        let cases =
            [(0x3c00, 1.0), (0xc000, -2.0), (0x7bff, 65504.0), (0x0001, 5.960_464_5e-8), (0x8000, -0.0)];
        for (bits, value) in cases {
            assert_eq!(float_from_half(bits).to_bits(), f32::to_bits(value), "{bits:#x}");
        }
        assert!(float_from_half(0x7e00).is_nan() && float_from_half(0xfc00) == f32::NEG_INFINITY);
    }

    #[test]
    fn halves_round_trip_and_other_values_round_to_nearest() {
        for half in (0..=0x7bff_u16).chain(0x8000..=0xfbff) {
            assert_eq!(half_from_float(float_from_half(half)), half, "{half:#x}");
        }
        for half in 0..0x7bff_u16 {
            let (low, high) = (float_from_half(half), float_from_half(half + 1));
            let even = if half % 2 == 0 { half } else { half + 1 };
            assert_eq!(half_from_float((low + high) / 2.0), even, "{half:#x}");
            assert_eq!(half_from_float(low + (high - low) * 0.49), half, "{half:#x}");
            assert_eq!(half_from_float(-low - (high - low) * 0.51), half + 0x8001, "{half:#x}");
        }
        assert_eq!(half_from_float(1e6), 0x7c00);
        assert!(float_from_half(half_from_float(f32::NAN)).is_nan());
    }
}
