//! Mapping of distributions to the unit interval.

use crate::Distribution;

/// Maps the numbers of a distribution to [0, 1]. Discrete numbers are bins of equal width (of equal ratio on
/// a logarithmic scale), so half a step is added at each end.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// Ordered numbers.
    Line(Line),
    /// A number of unordered choices.
    Choices(usize),
}

/// Ordered numbers on a linear or logarithmic scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    low: f64,
    high: f64,
    /// 0 for a continuous range.
    step: f64,
    log: bool,
}

impl Axis {
    pub fn new(distribution: &Distribution) -> Self {
        match distribution {
            Distribution::Float { low, high, log, step } => {
                Self::Line(Line { low: *low, high: *high, step: step.unwrap_or(0.0), log: *log })
            }
            Distribution::Int { low, high, log, step } => {
                Self::Line(Line { low: *low as f64, high: *high as f64, step: *step as f64, log: *log })
            }
            Distribution::Categorical { choices } => Self::Choices(choices.len()),
        }
    }

    /// Returns the number at `unit`, in [0, 1].
    pub fn number_from_unit(&self, unit: f64) -> f64 {
        match self {
            Self::Line(line) => line.number_from_unit(unit),
            Self::Choices(count) => (unit * *count as f64).floor().clamp(0.0, *count as f64 - 1.0),
        }
    }
}

impl Line {
    /// Returns start and length on the scale.
    fn extent(&self) -> (f64, f64) {
        let (start, end) =
            (self.scaled(self.low - self.step / 2.0), self.scaled(self.high + self.step / 2.0));
        (start, end - start)
    }

    fn scaled(&self, number: f64) -> f64 {
        if self.log { number.ln() } else { number }
    }

    pub fn unit_from_number(&self, number: f64) -> f64 {
        let (start, length) = self.extent();
        if length > 0.0 { (self.scaled(number) - start) / length } else { 0.5 }
    }

    pub fn number_from_unit(&self, unit: f64) -> f64 {
        let (start, length) = self.extent();
        let scaled = start + unit * length;
        let number = if self.log { scaled.exp() } else { scaled };
        let number = match self.step {
            0.0 => number,
            step => self.low + ((number - self.low) / step).round() * step,
        };
        number.clamp(self.low, self.high)
    }

    /// Returns the ends of the bin around `number`; `None` for a continuous range.
    pub fn bin(&self, number: f64) -> Option<(f64, f64)> {
        let half = self.step / 2.0;
        (half > 0.0).then(|| (self.unit_from_number(number - half), self.unit_from_number(number + half)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_bins() {
        let int = Axis::new(&Distribution::log_int(1, 8).unwrap());
        assert_eq!((int.number_from_unit(0.0), int.number_from_unit(1.0)), (1.0, 8.0));
        let Axis::Line(line) = int else { panic!() };
        let bins: Vec<_> = (1..=8).map(|number| line.bin(f64::from(number)).unwrap()).collect();
        assert!(bins[0].0.abs() < 1e-12 && (bins[7].1 - 1.0).abs() < 1e-12);
        assert!(bins.windows(2).all(|pair| (pair[0].1 - pair[1].0).abs() < 1e-12));
        let stepped = Axis::new(&Distribution::stepped_float(0.0, 1.0, 0.25).unwrap());
        let numbers: Vec<f64> =
            (0..5).map(|at| stepped.number_from_unit(0.1 + 0.2 * f64::from(at))).collect();
        assert_eq!(numbers, [0.0, 0.25, 0.5, 0.75, 1.0]);
        let log = Axis::new(&Distribution::log_float(1e-4, 1e-2).unwrap());
        assert!((log.number_from_unit(0.5) - 1e-3).abs() < 1e-12);
        assert_eq!(Axis::Choices(3).number_from_unit(1.0), 2.0);
    }
}
