//! Expected calibration error (Guo et al., On Calibration of Modern Neural Networks, ICML 2017).

use opendr_engine::{Error, Result};

use crate::{Curves, Figure, Line};

/// Number of bins of equal width over 0..=1.
const BINS: usize = 15;

/// One bin of a [`Calibration`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CalibrationBin {
    /// Number of predictions.
    pub count: u64,
    /// Number of correct predictions.
    pub correct: u64,
    /// Sum of the confidences.
    pub confidence: f64,
}

/// Compares confidence and accuracy in 15 bins `(i/15, (i+1)/15]` of confidence; a confidence of 0 is in the first bin.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Calibration {
    bins: [CalibrationBin; BINS],
}

impl Calibration {
    /// Adds a prediction.
    ///
    /// # Errors
    /// Returns `InvalidInput` if `confidence` is not in 0..=1.
    pub fn add(&mut self, correct: bool, confidence: f64) -> Result<()> {
        if !(0.0..=1.0).contains(&confidence) {
            return Err(Error::invalid_input(format!(
                "confidence {confidence} is not in 0..=1; give a probability"
            )));
        }
        let index = (1..BINS).take_while(|edge| confidence > *edge as f64 / BINS as f64).count();
        let bin = &mut self.bins[index];
        bin.count += 1;
        bin.correct += u64::from(correct);
        bin.confidence += confidence;
        Ok(())
    }

    /// Adds the predictions of another accumulator.
    pub fn merge(&mut self, other: &Self) {
        for (bin, more) in self.bins.iter_mut().zip(&other.bins) {
            bin.count += more.count;
            bin.correct += more.correct;
            bin.confidence += more.confidence;
        }
    }

    /// Returns the bins, lowest confidence first.
    pub fn bins(&self) -> &[CalibrationBin] {
        &self.bins
    }

    /// Returns the mean difference of confidence and accuracy over the bins, weighted by their predictions (Eq. 3); `None`
    /// without predictions.
    pub fn expected_error(&self) -> Option<f64> {
        let total: u64 = self.bins.iter().map(|bin| bin.count).sum();
        let gaps = self.bins.iter().map(|bin| (bin.correct as f64 - bin.confidence).abs());
        (total > 0).then(|| gaps.sum::<f64>() / total as f64)
    }

    /// Returns the largest difference of confidence and accuracy of a bin (Eq. 5); `None` without predictions.
    pub fn maximum_error(&self) -> Option<f64> {
        let filled = self.bins.iter().filter(|bin| bin.count > 0);
        filled.map(|bin| (bin.correct as f64 - bin.confidence).abs() / bin.count as f64).reduce(f64::max)
    }

    /// Returns the reliability diagram; `None` without predictions.
    pub(crate) fn figure(&self) -> Option<Figure> {
        let filled = self.bins.iter().filter(|bin| bin.count > 0);
        let mean = |sum: f64, bin: &CalibrationBin| sum / bin.count as f64;
        let points: Vec<[f64; 2]> =
            filled.map(|bin| [mean(bin.confidence, bin), mean(bin.correct as f64, bin)]).collect();
        let perfect = Line { label: "perfect".to_owned(), points: vec![[0.0, 0.0], [1.0, 1.0]] };
        (!points.is_empty()).then(|| {
            Figure::Curves(Curves {
                name: "reliability".to_owned(),
                title: "Reliability diagram".to_owned(),
                x: "confidence".to_owned(),
                y: "accuracy".to_owned(),
                lines: vec![perfect, Line { label: "predictions".to_owned(), points }],
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_belong_to_the_bin_below() {
        let mut calibration = Calibration::default();
        for confidence in [0.0, 1.0 / 15.0, 0.07, 14.0 / 15.0, 1.0] {
            calibration.add(true, confidence).unwrap();
        }
        let counts: Vec<u64> = calibration.bins().iter().map(|bin| bin.count).collect();
        assert_eq!(counts, [2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1]);
    }

    #[test]
    fn error_by_hand() {
        let mut calibration = Calibration::default();
        assert_eq!(calibration.expected_error(), None);
        assert_eq!(calibration.maximum_error(), None);
        calibration.add(true, 0.9).unwrap();
        calibration.add(false, 0.9).unwrap();
        let mut other = Calibration::default();
        other.add(true, 0.5).unwrap();
        other.add(true, 0.5).unwrap();
        calibration.merge(&other);
        assert!((calibration.expected_error().unwrap() - (0.4 * 2.0 + 0.5 * 2.0) / 4.0).abs() < 1e-12);
        assert!((calibration.maximum_error().unwrap() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn invalid_confidences_are_rejected() {
        let mut calibration = Calibration::default();
        for confidence in [f64::NAN, -0.1, 1.1, f64::INFINITY] {
            assert!(calibration.add(true, confidence).is_err());
        }
        assert_eq!(calibration, Calibration::default());
    }
}
