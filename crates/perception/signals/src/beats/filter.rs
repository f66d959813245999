//! Second-order filters.

use std::f64::consts::{PI, SQRT_2};

/// A second-order Butterworth filter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Filter {
    ahead: [f64; 3],
    back: [f64; 2],
}

/// State of a filter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct FilterMemory([f64; 2]);

impl Filter {
    /// Creates a low-pass filter with cutoff `cut` in Hz.
    pub fn low(cut: f64, rate: f64) -> Self {
        let k = (PI * cut / rate).tan();
        let scale = 1.0 / (1.0 + SQRT_2 * k + k * k);
        let ahead = k * k * scale;
        Self { ahead: [ahead, 2.0 * ahead, ahead], back: Self::back(k, scale) }
    }

    /// Creates a high-pass filter with cutoff `cut` in Hz.
    pub fn high(cut: f64, rate: f64) -> Self {
        let k = (PI * cut / rate).tan();
        let scale = 1.0 / (1.0 + SQRT_2 * k + k * k);
        Self { ahead: [scale, -2.0 * scale, scale], back: Self::back(k, scale) }
    }

    fn back(k: f64, scale: f64) -> [f64; 2] {
        [2.0 * (k * k - 1.0) * scale, (1.0 - SQRT_2 * k + k * k) * scale]
    }

    /// Filters the next sample.
    pub fn next(&self, memory: &mut FilterMemory, sample: f64) -> f64 {
        let FilterMemory([first, second]) = memory;
        let out = self.ahead[0] * sample + *first;
        *first = self.ahead[1] * sample - self.back[0] * out + *second;
        *second = self.ahead[2] * sample - self.back[1] * out;
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the remaining amplitude of a wave.
    fn gain(filter: Filter, hz: f64) -> f64 {
        let mut memory = FilterMemory::default();
        let wave = |at: usize| (2.0 * PI * hz * at as f64 / 360.0).sin();
        let filtered = (0..7200).map(|at| filter.next(&mut memory, wave(at)));
        filtered.skip(3600).fold(0.0, |most: f64, sample| most.max(sample.abs()))
    }

    #[test]
    fn half_the_power_is_left_at_the_cut() {
        for filter in [Filter::low(15.0, 360.0), Filter::high(15.0, 360.0)] {
            assert!((gain(filter, 15.0) - 0.5f64.sqrt()).abs() < 0.01);
        }
        assert!(gain(Filter::low(15.0, 360.0), 1.0) > 0.99 && gain(Filter::low(15.0, 360.0), 60.0) < 0.07);
        assert!(gain(Filter::high(5.0, 360.0), 0.5) < 0.02 && gain(Filter::high(5.0, 360.0), 30.0) > 0.95);
    }
}
