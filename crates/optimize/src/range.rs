//! Mapping of a tensor's values to bytes.

use crate::histogram::Histogram;
use crate::options::Calibration;

/// Share of the values that `Calibration::Percentile` clips at each end.
const LEFT_OUT: f64 = 1e-4;
/// Number of candidate ranges.
const TRIALS: usize = 100;

/// An affine quantisation: `value = (byte - zero_point) * scale`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub scale: f32,
    pub zero_point: u8,
}

impl Range {
    /// Returns the range for `low..=high`, widened to include zero, which padding and rectifiers need exactly.
    pub fn over(low: f32, high: f32) -> Self {
        let (low, high) = (low.min(0.0), high.max(0.0));
        let scale = (high - low) / 255.0;
        if !(scale.is_finite() && scale >= f32::MIN_POSITIVE) {
            return Self { scale: 1.0, zero_point: 0 };
        }
        Self { scale, zero_point: (-low / scale).round() as u8 }
    }

    /// Returns the range for the values of a histogram.
    pub fn chosen(histogram: &Histogram, by: Calibration) -> Self {
        let Some((low, high)) = histogram.range() else { return Self::over(0.0, 0.0) };
        match by {
            Calibration::MinMax => Self::over(low, high),
            Calibration::Percentile => {
                let (low, high) = histogram.range_without(LEFT_OUT).unwrap_or((low, high));
                Self::over(low, high)
            }
            Calibration::LeastSquares => best(low, high, |range| range.noise(histogram)),
            Calibration::Entropy => best(low, high, |range| range.divergence(histogram)),
        }
    }

    /// Returns a value after quantisation and dequantisation.
    pub fn rounded(self, value: f64) -> f64 {
        let (scale, zero) = (f64::from(self.scale), f64::from(self.zero_point));
        (((value / scale).round_ties_even() + zero).clamp(0.0, 255.0) - zero) * scale
    }

    /// Returns the sum of squared errors.
    fn noise(self, histogram: &Histogram) -> f64 {
        histogram.bins().map(|(value, count)| (value - self.rounded(value)).powi(2) * count as f64).sum()
    }

    /// Returns the signal-to-noise ratio in decibels.
    pub fn signal_to_noise(self, histogram: &Histogram) -> f64 {
        let signal: f64 = histogram.bins().map(|(value, count)| value * value * count as f64).sum();
        decibels(signal, self.noise(histogram))
    }

    /// Returns the Kullback-Leibler divergence of the dequantised values from the values clipped to the range. The
    /// values of each byte are spread evenly over its bins.
    fn divergence(self, histogram: &Histogram) -> f64 {
        let mut bytes = vec![(0_u64, 0_u32); 256];
        let byte = |value: f64| {
            let byte = (value / f64::from(self.scale)).round() + f64::from(self.zero_point);
            byte.clamp(0.0, 255.0) as usize
        };
        let (low, high) = (self.rounded(f64::NEG_INFINITY), self.rounded(f64::INFINITY));
        let mut clipped = [0_u64; 2];
        for (value, count) in histogram.bins() {
            if value < low {
                clipped[0] += count;
            } else if value > high {
                clipped[1] += count;
            } else if let Some((sum, bins)) = bytes.get_mut(byte(value)) {
                *sum += count;
                *bins += 1;
            }
        }
        let total: u64 = histogram.bins().map(|(_, count)| count).sum();
        let mut divergence = 0.0;
        let mut inside = histogram.bins().filter(|(value, _)| (low..=high).contains(value)).peekable();
        let mut first = true;
        while let Some((value, count)) = inside.next() {
            let edge =
                (if first { clipped[0] } else { 0 }) + (if inside.peek().is_none() { clipped[1] } else { 0 });
            first = false;
            let (sum, bins) = bytes.get(byte(value)).copied().unwrap_or((1, 1));
            let p = (count + edge) as f64 / total as f64;
            let q = sum as f64 / f64::from(bins.max(1)) / (total - clipped[0] - clipped[1]).max(1) as f64;
            divergence += p * (p / q).ln();
        }
        divergence
    }
}

/// Returns the range with the least loss among shares of the whole one.
fn best(low: f32, high: f32, loss: impl Fn(Range) -> f64) -> Range {
    let ranges = (TRIALS / 5..=TRIALS).map(|part| {
        let share = part as f32 / TRIALS as f32;
        Range::over(low * share, high * share)
    });
    let losses = ranges.map(|range| (range, loss(range)));
    losses.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(Range::over(low, high), |(range, _)| range)
}

/// Returns the ratio of two sums of squares in decibels, 10 log10; at most 200.
pub fn decibels(signal: f64, noise: f64) -> f64 {
    if signal <= 0.0 {
        return if noise <= 0.0 { 200.0 } else { 0.0 };
    }
    (10.0 * (signal / noise).log10()).min(200.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_and_the_limits_round_trip() {
        for (low, high) in [(-1.0, 3.0), (0.5, 2.0), (-4.0, -1.0), (0.0, 1e-3)] {
            let range = Range::over(low, high);
            assert_eq!(range.rounded(0.0), 0.0);
            for end in [low, high] {
                assert!(
                    (range.rounded(f64::from(end)) - f64::from(end)).abs() <= f64::from(range.scale) * 0.5001
                );
            }
        }
        assert_eq!(Range::over(0.0, 0.0), Range { scale: 1.0, zero_point: 0 });
        assert_eq!(Range::over(f32::NEG_INFINITY, 1.0).scale, 1.0);
    }

    #[test]
    fn outliers_are_clipped_where_that_reduces_the_error() {
        let mut histogram = Histogram::default();
        let bell: Vec<f32> = (1..100_000).map(|at| (at as f32 / 100_000.0).ln()).collect();
        (0..30).for_each(|_| histogram.add(&bell));
        histogram.add(&[-60.0]);
        let of = |by| Range::chosen(&histogram, by);
        let all = of(Calibration::MinMax);
        for by in [Calibration::LeastSquares, Calibration::Percentile, Calibration::Entropy] {
            assert!(of(by).scale < 0.7 * all.scale, "{by:?}");
            assert!(of(by).scale * 255.0 > 4.0, "{by:?}");
        }
        assert!(of(Calibration::LeastSquares).signal_to_noise(&histogram) > all.signal_to_noise(&histogram));
    }
}
