//! Ambiguity of a map of values of which a robot selects the highest.
//!
//! As OpenDR's `AmbiguityMeasure`, for maps of Transporter Nets (A. Zeng et al., CoRL 2020) and the like: the probabilities of
//! the map's peaks ([`persistence`]) are a softmax of their values. Different from OpenDR, a map is ambiguous when the best
//! peak is *not* certain.

pub mod persistence;

use opendr_engine::learner::{Learner, Spec, Targets};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes, Heatmap, HeatmapValues};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::category_scores::binary_category;

use persistence::{Peak, Persistence};

/// Parameters of [`AmbiguityMeasure`].
#[derive(Debug, Clone, Params)]
pub struct AmbiguityMeasureParams {
    /// Minimum probability of all peaks except the best one at which a map is ambiguous.
    #[param(default = 0.5, range = 0.0..=0.999_999, live)]
    pub threshold: f64,
    /// Temperature of the softmax; a higher one makes maps more ambiguous.
    #[param(default = 1.0, range = 1e-6..=1e6, live)]
    pub temperature: f64,
}

/// Prediction for a map.
#[derive(Default, Targets)]
pub struct AmbiguityMeasureTargets {
    /// Class 1 if the map is ambiguous, else 0; the probabilities are those of the best peak and of all others.
    pub category: Category,
    /// Peaks `[peaks, 4]`: row, column, value and probability, sorted by persistence.
    pub peaks: Heatmap,
}

/// Learner of the ambiguity of maps.
pub struct AmbiguityMeasure {
    params: AmbiguityMeasureParams,
    classes: Classes,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    persistence: Persistence,
    peaks: Vec<Peak>,
}

/// Maximum number of pixels of a map.
const MOST_PIXELS: usize = 1 << 26;

impl Learner for AmbiguityMeasure {
    const SPEC: Spec = Spec::new("ambiguity_measure", Task::AmbiguityMeasure)
        .class("AmbiguityMeasureLearner")
        .about("Measures whether the highest peak of a map of values is ambiguous.");
    type Params = AmbiguityMeasureParams;
    type Input<'a> = &'a Heatmap;
    type Target = AmbiguityMeasureTargets;
    type State = ();

    fn load(_: &Model, params: AmbiguityMeasureParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &AmbiguityMeasureParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut AmbiguityMeasureParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), map: &Heatmap, targets: &mut AmbiguityMeasureTargets) -> Result<()> {
        let (&[height, width], HeatmapValues::Scores(values)) = (map.shape(), map.values()) else {
            return Err(Error::invalid_input(format!(
                "the map has shape {:?}; it must be a map of scores [height, width]",
                map.shape()
            )));
        };
        if values.is_empty() || values.len() > MOST_PIXELS {
            return Err(Error::invalid_input(format!(
                "the map has {height}x{width} values; it must have 1 to {MOST_PIXELS}"
            )));
        }
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            let (row, column) = (at / width, at % width);
            return Err(Error::invalid_input(format!(
                "the value in row {row}, column {column} is {}; all values must be finite",
                values[at]
            )));
        }
        let Work { persistence, peaks } = &mut *self.work.take();
        persistence.peaks(values, width, peaks);
        let AmbiguityMeasureParams { threshold, temperature } = self.params;
        let highest = peaks.first().map_or(0.0, |peak| f64::from(peak.value));
        let weight = |peak: &Peak| ((f64::from(peak.value) - highest) / temperature).exp();
        let sum: f64 = peaks.iter().map(weight).sum();
        let rows = targets.peaks.scores_mut(&[peaks.len(), 4]);
        for (row, peak) in rows.chunks_exact_mut(4).zip(&*peaks) {
            let place = [peak.at / width, peak.at % width].map(|at| at as f32);
            row.copy_from_slice(&[place[0], place[1], peak.value, (weight(peak) / sum) as f32]);
        }
        // The highest peak is the first, with the weight 1.
        let ambiguity = 1.0 - 1.0 / sum;
        let is_ambiguous = ambiguity >= threshold && peaks.len() > 1;
        binary_category(&mut targets.category, is_ambiguous, ambiguity as f32, &self.classes);
        Ok(())
    }
}

impl AmbiguityMeasure {
    /// Creates the learner; it needs no model.
    pub fn with_params(params: AmbiguityMeasureParams) -> Self {
        Self { params, classes: ["clear", "ambiguous"].into_iter().collect(), work: Pool::default() }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    fn measure(map: &Heatmap, threshold: f64, temperature: f64) -> Result<AmbiguityMeasureTargets> {
        let measure = AmbiguityMeasure::with_params(AmbiguityMeasureParams { threshold, temperature });
        let mut targets = AmbiguityMeasureTargets::default();
        measure.infer_into(&mut (), map, &mut targets)?;
        Ok(targets)
    }

    fn map(values: &[f32]) -> Heatmap {
        Heatmap::from_scores(values.to_vec(), &[1, values.len()]).unwrap()
    }

    #[test]
    fn two_equal_peaks_are_ambiguous_and_one_is_not() {
        let two = measure(&map(&[3.0, 0.0, 3.0]), 0.5, 1.0).unwrap();
        assert_eq!((two.category.class, two.category.confidence), (1, Some(0.5)));
        let one = measure(&map(&[9.0, 0.0, 1.0]), 0.5, 1.0).unwrap();
        assert_eq!(one.category.class, 0);
        assert_eq!(one.peaks.shape(), [2, 4]);
        let HeatmapValues::Scores(peaks) = one.peaks.values() else { panic!() };
        // Softmax of 9 and 1, computed with NumPy.
        for (found, expected) in peaks.iter().zip([0.0, 0.0, 9.0, 0.999_664_6, 0.0, 2.0, 1.0, 0.000_335_35]) {
            assert!((found - expected).abs() < 1e-6, "{peaks:?}");
        }
        assert_eq!(measure(&map(&[9.0, 0.0, 1.0]), 0.3, 20.0).unwrap().category.class, 1);
        // A single peak is certain at every threshold.
        assert_eq!(measure(&map(&[2.0, 2.0]), 0.0, 1.0).unwrap().category.class, 0);
    }

    #[test]
    fn huge_values_do_not_overflow() {
        let huge =
            measure(&map(&[f32::MAX, 0.0, f32::MAX, -f32::MAX, f32::MIN_POSITIVE]), 0.5, 1e-6).unwrap();
        assert_eq!(huge.category.probabilities, [0.5, 0.5]);
    }

    #[test]
    fn invalid_maps_are_refused() {
        let labels = Heatmap::from_labels(vec![1, 2], &[1, 2]).unwrap();
        let row = Heatmap::from_scores(vec![1.0, 2.0], &[2]).unwrap();
        let empty = Heatmap::from_scores(vec![], &[0, 5]).unwrap();
        for wrong in [labels, row, empty, map(&[1.0, f32::NAN]), map(&[f32::INFINITY])] {
            assert_eq!(measure(&wrong, 0.5, 1.0).map(|_| ()).unwrap_err().kind(), ErrorKind::InvalidInput);
        }
    }
}
