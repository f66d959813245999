//! Axes of figures.

/// The range of an axis and its ticks.
pub struct Axis {
    pub low: f64,
    pub high: f64,
    pub step: f64,
}

impl Axis {
    /// Creates an axis around `values` with about five ticks at round numbers; 0 to 1 if the values are in that range.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let range = values.filter(|value| value.is_finite()).fold(None, |range, value| match range {
            None => Some((value, value)),
            Some((low, high)) => Some((value.min(low), value.max(high))),
        });
        let (low, high) = range.unwrap_or((0.0, 1.0));
        if (0.0..=1.0).contains(&low) && (0.0..=1.0).contains(&high) {
            return Self { low: 0.0, high: 1.0, step: 0.2 };
        }
        let width = if high > low { high - low } else { low.abs().max(1.0) };
        let rough = width / 5.0;
        let power = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].into_iter().find(|times| times * power >= rough).unwrap_or(10.0) * power;
        Self {
            low: (low / step).floor() * step,
            high: (high / step).ceil().max((low / step).floor() + 1.0) * step,
            step,
        }
    }

    /// Returns the relative position of a value: 0 at the low end, 1 at the high end.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Returns the ticks and their labels.
    pub fn ticks(&self) -> impl Iterator<Item = (f64, String)> {
        let count = ((self.high - self.low) / self.step).round() as usize;
        let places = (-self.step.log10().floor()).clamp(0.0, 9.0) as usize;
        (0..=count).map(move |at| {
            let value = self.low + self.step * at as f64;
            (value, format!("{value:.places$}"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_surround_the_values() {
        let ticks = |values: &[f64]| -> Vec<String> {
            Axis::around(values.iter().copied()).ticks().map(|(_, text)| text).collect()
        };
        assert_eq!(ticks(&[0.1, 0.9]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(ticks(&[-3.0, 117.0]), ["-50", "0", "50", "100", "150"]);
        assert_eq!(ticks(&[7.0]), ["6", "8"]);
        assert_eq!(ticks(&[f64::NAN]), ticks(&[]));
        for values in [[1e-9, 3.0], [1e12, 1.001e12], [-4e-7, 4e-7]] {
            let axis = Axis::around(values.into_iter());
            assert!(axis.low <= values[0] && values[1] <= axis.high && axis.ticks().count() < 12);
        }
    }
}
