//! Sine and cosine with the same bits on every system, vectorised by the compiler.
//!
//! The polynomials of fdlibm's `__kernel_sin` and `__kernel_cos` (Sun Microsystems, 1993) after a reduction by
//! multiples of pi/2 in three parts (Cody and Waite, 1980), without a branch. The standard library's results differ
//! between systems in the last bit, and so would episodes.

use std::f64::consts::FRAC_2_PI;

/// Adding it rounds to a whole number, which is then in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// pi/2 in parts; the first two have 33 bits, so that multiples up to 2^20 are exact.
const HALF_PI: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// Returns sine and cosine of an angle in radians, to about one unit in the last place below 1e6.
#[inline(always)]
pub(crate) fn sine_cosine(angle: f64) -> (f64, f64) {
    let shifted = angle * FRAC_2_PI + ROUND;
    let turns = shifted - ROUND;
    let quadrant = shifted.to_bits();

    let coarse = angle - turns * HALF_PI[0];
    let part = turns * HALF_PI[1];
    let rest = coarse - part;
    let x = rest + (((coarse - rest) - part) - turns * HALF_PI[2]);

    let z = x * x;
    let sine = sine_near_zero(x, z);
    let cosine = cosine_near_zero(z);
    // A mask instead of a branch: baseline x86-64 has no comparison of 64-bit integers.
    let odd = (quadrant & 1).wrapping_neg();
    let swapped = (sine.to_bits() ^ cosine.to_bits()) & odd;
    let sine_sign = (quadrant & 2) << 62;
    let cosine_sign = (quadrant.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits(sine.to_bits() ^ swapped ^ sine_sign),
        f64::from_bits(cosine.to_bits() ^ swapped ^ cosine_sign),
    )
}

#[inline(always)]
fn sine_near_zero(x: f64, z: f64) -> f64 {
    const S: [f64; 6] = [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    x + x * z * (S[0] + z * (S[1] + z * (S[2] + z * (S[3] + z * (S[4] + z * S[5])))))
}

#[inline(always)]
fn cosine_near_zero(z: f64) -> f64 {
    const C: [f64; 6] = [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let half = 0.5 * z;
    let near = 1.0 - half;
    let series = z * (C[0] + z * (C[1] + z * (C[2] + z * (C[3] + z * (C[4] + z * C[5])))));
    near + (((1.0 - near) - half) + z * series)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_as_exact_as_the_standard_library() {
        let mut worst = 0.0_f64;
        for step in -400_000_i32..400_000 {
            let angle = f64::from(step) * 1.000_37e-4 * (1.0 + f64::from(step.abs() % 7) * 300.0);
            let (sine, cosine) = sine_cosine(angle);
            worst = worst.max((sine - angle.sin()).abs()).max((cosine - angle.cos()).abs());
        }
        assert!(worst < 3e-16, "{worst:e}");
        assert_eq!(sine_cosine(0.0), (0.0, 1.0));
    }

    #[test]
    fn infinities_and_nan_give_nan() {
        assert!(sine_cosine(f64::NAN).0.is_nan() && sine_cosine(f64::INFINITY).1.is_nan());
    }
}
