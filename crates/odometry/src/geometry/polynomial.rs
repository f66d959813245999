//! Real roots of polynomials.

/// Writes the real roots of the polynomial with these coefficients, highest power first, and returns their number.
///
/// Between two neighbouring roots of the derivative there is at most one root, which bisection with Newton's steps finds.
pub(super) fn real_roots(coefficients: &[f64; 5], roots: &mut [f64; 4]) -> usize {
    let largest = coefficients.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return 0;
    }
    // Coefficients of the derivatives, from the first power up: a line, a parabola, a cubic, the quartic.
    let mut found = [0.0; 4];
    let mut count = 0;
    for order in (0..4).rev() {
        let mut derived = [0.0; 5];
        for (at, part) in coefficients.iter().take(5 - order).enumerate() {
            let power = 4 - at;
            let factor: f64 = (0..order).map(|step| (power - step) as f64).product();
            derived[at] = factor * part;
        }
        let derived = &derived[..5 - order];
        let bound = 1e6;
        let mut next = [0.0; 4];
        let mut more = 0;
        let mut low = -bound;
        for high in found.into_iter().take(count).chain([bound]) {
            if let Some(root) = root_between(derived, low, high)
                && more < 4
            {
                next[more] = root;
                more += 1;
            }
            low = high;
        }
        (found, count) = (next, more);
    }
    *roots = found;
    count
}

fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().fold(0.0, |sum, part| sum * x + part)
}

fn root_between(coefficients: &[f64], mut low: f64, mut high: f64) -> Option<f64> {
    let (at_low, at_high) = (value(coefficients, low), value(coefficients, high));
    if at_low == 0.0 {
        return Some(low);
    }
    if (at_low < 0.0) == (at_high < 0.0) {
        return None;
    }
    let mut x = 0.5 * (low + high);
    for _ in 0..100 {
        let (mut level, mut slope) = (0.0, 0.0);
        for part in coefficients {
            slope = slope * x + level;
            level = level * x + part;
        }
        if level == 0.0 {
            return Some(x);
        }
        if (level < 0.0) == (at_low < 0.0) {
            low = x
        } else {
            high = x
        }
        let newton = x - level / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= 1e-14 * x.abs().max(1e-3) {
            return Some(next);
        }
        x = next;
    }
    Some(x)
}
