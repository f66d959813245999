//! The standard normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Returns the probability of the interval from `start` to `end`.
pub fn mass(start: f64, end: f64) -> f64 {
    // On the side where both tails are small, nothing cancels.
    let (start, end) = if start > 0.0 { (-end, -start) } else { (start, end) };
    if end <= 0.0 {
        0.5 * (erfc(-end * FRAC_1_SQRT_2) - erfc(-start * FRAC_1_SQRT_2))
    } else {
        1.0 - 0.5 * (erfc(end * FRAC_1_SQRT_2) + erfc(-start * FRAC_1_SQRT_2))
    }
}

/// Returns the logarithm of [`mass`]; for thin or distant intervals, the log-density at the middle plus the log-width.
pub fn log_mass(start: f64, end: f64) -> f64 {
    let (width, middle) = (end - start, (start + end) / 2.0);
    if width * middle.abs().max(1.0) < 1e-3 {
        return -0.5 * middle * middle - 0.5 * (2.0 * PI).ln() + width.ln();
    }
    mass(start, end).ln()
}

/// Returns the complementary error function for x >= 0, with a relative error of about 1e-14.
fn erfc(x: f64) -> f64 {
    if x < 2.5 {
        // erf x = 2 / sqrt(pi) exp(-x^2) sum of 2^n x^(2n+1) / (2n+1)!!
        let (mut term, mut sum) = (x, x);
        for n in 1..100 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
            if term < 1e-17 * sum {
                break;
            }
        }
        return 1.0 - 2.0 / PI.sqrt() * (-x * x).exp() * sum;
    }
    // Laplace's continued fraction, from its far end.
    let fraction = (1..=60).rev().fold(x, |tail, n| x + 0.5 * f64::from(n) / tail);
    (-x * x).exp() / (PI.sqrt() * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of SciPy's `erfc`.
    #[test]
    fn erfc_matches_scipy() {
        for (x, expected) in [
            (0.0, 1.0),
            (0.1, 0.8875370839817152),
            (1.0, 0.15729920705028513),
            (2.4, 0.0006885138966450786),
            (2.6, 0.00023603441652934923),
            (5.0, 1.5374597944280347e-12),
            (20.0, 5.395865611607901e-176),
        ] {
            assert!((erfc(x) / expected - 1.0).abs() < 1e-11, "{x}: {} {expected}", erfc(x));
        }
        assert_eq!(erfc(30.0), 0.0);
    }

    #[test]
    fn masses() {
        assert!((mass(-1.0, 1.0) - 0.6826894921370859).abs() < 1e-15);
        assert!((mass(3.0, 4.0) / 0.0013182267897969734 - 1.0).abs() < 1e-10);
        assert!((mass(-4.0, -3.0) / mass(3.0, 4.0) - 1.0).abs() < 1e-15);
        for place in [0.0, 0.7, -2.0, 6.0] {
            let (thin, thick) = (log_mass(place, place + 1e-4), log_mass(place, place + 2e-3));
            assert!((thick - thin - 20f64.ln()).abs() < 7e-3, "{place}: {thin} {thick}");
        }
    }
}
