//! The 1 EUR filter: an adaptive low-pass filter, strong at rest and weak in motion.
//!
//! Casiez, Roussel and Vogel, "1 EUR Filter: A Simple Speed-based Low-pass Filter for Noisy Input in Interactive
//! Systems", CHI 2012.

use std::f32::consts::TAU;

/// Parameters of the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OneEuro {
    /// Cut-off frequency at rest, in hertz; lower values reduce jitter.
    pub(crate) min_cutoff: f32,
    /// Increase of the cut-off frequency per speed, in hertz; higher values reduce lag.
    pub(crate) beta: f32,
    /// Cut-off frequency of the speed, in hertz.
    pub(crate) speed_cutoff: f32,
}

/// State of a filtered signal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Smoothed {
    value: f32,
    /// Units per second.
    speed: f32,
}

impl Smoothed {
    /// Starts a signal.
    pub(crate) fn new(value: f32) -> Self {
        Self { value, speed: 0.0 }
    }

    /// Returns the next value, `seconds` after the last one, filtered. A unit of speed is `unit` of the signal per second.
    pub(crate) fn next(&mut self, filter: &OneEuro, value: f32, seconds: f32, unit: f32) -> f32 {
        let speed = (value - self.value) / (seconds * unit);
        self.speed += weight(filter.speed_cutoff, seconds) * (speed - self.speed);
        let cutoff = filter.min_cutoff + filter.beta * self.speed.abs();
        self.value += weight(cutoff, seconds) * (value - self.value);
        self.value
    }
}

/// Returns the weight of a new value in a low-pass filter (Eq. 4 and 5).
fn weight(cutoff: f32, seconds: f32) -> f32 {
    let part = TAU * cutoff * seconds;
    part / (part + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILTER: OneEuro = OneEuro { min_cutoff: 1.0, beta: 1.0, speed_cutoff: 1.0 };
    const SECONDS: f32 = 1.0 / 30.0;

    #[test]
    fn jitter_is_reduced_and_motion_has_little_lag() {
        let mut signal = Smoothed::new(100.0);
        let jitter: Vec<f32> = (0..60)
            .map(|at| signal.next(&FILTER, 100.0 + if at % 2 == 0 { 1.0 } else { -1.0 }, SECONDS, 50.0))
            .collect();
        let largest = jitter[30..].iter().map(|value| (value - 100.0).abs()).fold(0.0, f32::max);
        assert!(largest < 0.3, "{largest}");
        let slow = OneEuro { beta: 0.0, ..FILTER };
        let lag = |filter: &OneEuro| {
            let mut signal = Smoothed::new(0.0);
            let followed = (1..=30).map(|at| signal.next(filter, 10.0 * at as f32, SECONDS, 50.0));
            300.0 - followed.last().unwrap_or_default()
        };
        assert!(lag(&FILTER) < 0.35 * lag(&slow), "{} {}", lag(&FILTER), lag(&slow));
    }

    /// Eq. 5: alpha = 1 / (1 + tau / Te), tau = 1 / (2 pi fc).
    #[test]
    fn weights_are_the_papers() {
        let tau = 1.0 / (TAU * 3.0);
        assert!((weight(3.0, SECONDS) - 1.0 / (1.0 + tau / SECONDS)).abs() < 1e-6);
    }
}
