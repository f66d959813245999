//! Arc tangent with the same bits on every system.
//!
//! The polynomial and the reduction of fdlibm's `s_atan.c` (Sun Microsystems, 1993). The standard library's results differ
//! between systems in the last bit, and so would episodes.

use std::f64::consts::{FRAC_PI_2, PI};

/// Coefficients of odd powers from the third.
const COEFFICIENTS: [f64; 11] = [
    3.333_333_333_333_293e-1,
    -1.999_999_999_987_648_3e-1,
    1.428_571_427_250_346_6e-1,
    -1.111_111_040_546_235_6e-1,
    9.090_887_133_436_507e-2,
    -7.691_876_205_044_83e-2,
    6.661_073_137_387_531e-2,
    -5.833_570_133_790_573_5e-2,
    4.976_877_994_615_932_4e-2,
    -3.653_157_274_421_691_6e-2,
    1.628_582_011_536_578_2e-2,
];
/// Angles to which arguments are reduced: arc tangents of 0.5, 1 and 1.5.
const ANGLES: [f64; 3] = [4.636_476_090_008_061e-1, std::f64::consts::FRAC_PI_4, 9.827_937_232_473_29e-1];

/// Returns the arc tangent of a number that is not negative.
fn arctangent(x: f64) -> f64 {
    let (base, reduced) = if x < 0.4375 {
        (0.0, x)
    } else if x < 0.6875 {
        (ANGLES[0], (2.0 * x - 1.0) / (2.0 + x))
    } else if x < 1.1875 {
        (ANGLES[1], (x - 1.0) / (x + 1.0))
    } else if x < 2.4375 {
        (ANGLES[2], (x - 1.5) / (1.0 + 1.5 * x))
    } else {
        (FRAC_PI_2, -1.0 / x)
    };
    let square = reduced * reduced;
    let series = COEFFICIENTS.iter().rev().fold(0.0, |sum, coefficient| sum * square + coefficient);
    base + (reduced - reduced * square * series)
}

/// Returns the angle of the point (`x`, `y`) in radians, from -pi to pi; 0 for the origin, NaN for NaN.
pub(crate) fn arctangent2(y: f64, x: f64) -> f64 {
    let (across, along) = (y.abs(), x.abs());
    let angle = match (across == 0.0, along == 0.0) {
        (true, _) => 0.0,
        (_, true) => FRAC_PI_2,
        _ => arctangent(across / along),
    };
    let angle = if x < 0.0 { PI - angle } else { angle };
    let angle = if y < 0.0 { -angle } else { angle };
    if x.is_nan() || y.is_nan() { f64::NAN } else { angle }
}

/// Returns the angle in [0, pi] of a cosine, which is clipped to [-1, 1].
pub(crate) fn arccosine(cosine: f64) -> f64 {
    let cosine = cosine.clamp(-1.0, 1.0);
    arctangent2(((1.0 - cosine) * (1.0 + cosine)).sqrt(), cosine)
}

/// Returns an angle in radians as one of [-pi, pi].
pub(crate) fn wrapped(angle: f64) -> f64 {
    angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_as_exact_as_the_standard_library() {
        let mut worst = 0.0_f64;
        for step in 0..200_000 {
            let angle = f64::from(step - 100_000) * 3.141e-5;
            let (sine, cosine) = angle.sin_cos();
            let size = 1.0 + f64::from(step % 13);
            let found = arctangent2(size * sine, size * cosine);
            worst = worst.max((found - (size * sine).atan2(size * cosine)).abs());
            worst = worst.max((arccosine(cosine) - cosine.acos()).abs() / 10.0);
        }
        assert!(worst < 1e-15, "{worst:e}");
        assert_eq!((arctangent2(0.0, 0.0), arctangent2(0.0, -1.0)), (0.0, PI));
        assert_eq!((arctangent2(-2.0, 0.0), arctangent2(1.0, f64::INFINITY)), (-FRAC_PI_2, 0.0));
        assert!(arctangent2(f64::NAN, 1.0).is_nan() && arctangent2(1.0, f64::NAN).is_nan());
        assert!((wrapped(7.0) - (7.0 - std::f64::consts::TAU)).abs() < 1e-15);
    }
}
