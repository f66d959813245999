//! Depth and stereo: relative and squared errors, fraction of pixels within a factor, fraction of bad pixels.

mod alignment;
mod pixels;

use std::collections::BTreeMap;

use opendr_engine::params::Params;
use opendr_engine::target::{Heatmap, HeatmapValues};
use opendr_engine::{Error, Result};

pub use self::alignment::{AlignedDepth, DepthAlignment};
use self::pixels::pairs;
use crate::average::ratio;
use crate::{Metric, Report};

opendr_engine::choices! {
    /// Quantity in a depth map.
    pub enum DepthQuantity {
        /// Distance in metres.
        Depth = "depth",
        /// Shift between the two images of a stereo camera, in pixels.
        Disparity = "disparity",
    }
}

/// Parameters of [`Depth`].
#[derive(Debug, Clone, Params)]
pub struct DepthParams {
    /// Quantity in the maps.
    pub quantity: DepthQuantity,
    /// How the predictions of an image are aligned with its ground truth, for depths that are known up to scale and shift.
    pub alignment: DepthAlignment,
    /// Smallest depth: smaller ground truth is ignored, smaller predictions are raised to it.
    #[param(default = 1e-3, range = 1e-9..=1e6, unit = "m")]
    pub min_depth: f64,
    /// Largest depth: larger ground truth is ignored, larger predictions are lowered to it.
    #[param(range = 1e-9..=1e9, unit = "m")]
    pub max_depth: Option<f64>,
}

/// Errors of depth, each a mean over the pixels of an image (Eigen et al., 2014).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DepthErrors {
    /// Absolute error divided by the ground truth.
    pub absolute_relative: f64,
    /// Squared error divided by the ground truth, in metres.
    pub squared_relative: f64,
    /// Root mean square error, in metres.
    pub rmse: f64,
    /// Root mean square error of the natural logarithms.
    pub rmse_log: f64,
    /// Standard deviation of the error of the natural logarithms: [`DepthErrors::rmse_log`] at the best scale.
    pub scale_invariant_log: f64,
    /// Fractions of the pixels whose ratio to the ground truth, or its inverse, is below 1.25, 1.25² and 1.25³.
    pub within: [f64; 3],
}

impl DepthErrors {
    /// Computes the errors over the pixels of an image whose ground truth is finite and within `range` metres; `None` if
    /// there are none. Predictions are aligned and then limited to `range`.
    ///
    /// # Errors
    /// As [`DepthAlignment::align`].
    pub fn of(
        ground_truth: &[f32],
        predicted: &[f32],
        range: [f64; 2],
        alignment: DepthAlignment,
    ) -> Result<Option<Self>> {
        let Some(aligned) = alignment.align(ground_truth, predicted, range)? else { return Ok(None) };
        let (mut count, mut sums, mut within) = (0_u64, [0.0; 5], [0_u64; 3]);
        for (ground_truth, predicted) in pairs(ground_truth, predicted, range)? {
            let predicted = aligned.depth(predicted).clamp(range[0], range[1]);
            let (error, log) = (predicted - ground_truth, (predicted / ground_truth).ln());
            let terms =
                [error.abs() / ground_truth, error * error / ground_truth, error * error, log * log, log];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            let factor = (predicted / ground_truth).max(ground_truth / predicted);
            for (count, bound) in within.iter_mut().zip([1.25, 1.25 * 1.25, 1.25 * 1.25 * 1.25]) {
                *count += u64::from(factor < bound);
            }
            count += 1;
        }
        let [absolute_relative, squared_relative, squared, log_squared, log] =
            sums.map(|sum| sum / count as f64);
        Ok(Some(Self {
            absolute_relative,
            squared_relative,
            rmse: squared.sqrt(),
            rmse_log: log_squared.sqrt(),
            scale_invariant_log: (log_squared - log * log).max(0.0).sqrt(),
            within: within.map(|within| within as f64 / count as f64),
        }))
    }

    /// Returns all errors with the keys of the report.
    pub fn numbers(&self) -> [(&'static str, f64); 8] {
        let [first, second, third] = self.within;
        [
            ("abs_rel", self.absolute_relative),
            ("sq_rel", self.squared_relative),
            ("rmse", self.rmse),
            ("rmse_log", self.rmse_log),
            ("silog", self.scale_invariant_log),
            ("delta1", first),
            ("delta2", second),
            ("delta3", third),
        ]
    }
}

/// Errors of disparity, accumulated over pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DisparityErrors {
    /// Number of pixels with ground truth.
    pub pixels: u64,
    /// Sum of the absolute errors, in pixels.
    pub distance: f64,
    /// Number of pixels with an error of more than 1, 2 and 3 pixels.
    pub bad: [u64; 3],
    /// Number of pixels with an error of more than 3 pixels and more than 5 %: KITTI's outliers, D1.
    pub outliers: u64,
}

impl DisparityErrors {
    /// Computes the errors over the pixels of an image whose ground truth is finite and above 0.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the maps differ in size or the prediction of such a pixel is NaN or infinite.
    pub fn of(ground_truth: &[f32], predicted: &[f32]) -> Result<Self> {
        let mut errors = Self::default();
        for (ground_truth, predicted) in pairs(ground_truth, predicted, [f64::MIN_POSITIVE, f64::MAX])? {
            let distance = (predicted - ground_truth).abs();
            if !distance.is_finite() {
                return Err(Error::invalid_input(
                    "a disparity is infinite; give finite numbers, 0 for points at infinity",
                ));
            }
            errors.pixels += 1;
            errors.distance += distance;
            for (bad, bound) in errors.bad.iter_mut().zip([1.0, 2.0, 3.0]) {
                *bad += u64::from(distance > bound);
            }
            errors.outliers += u64::from(distance > 3.0 && distance / ground_truth > 0.05);
        }
        Ok(errors)
    }

    fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.distance += other.distance;
        self.outliers += other.outliers;
        self.bad.iter_mut().zip(other.bad).for_each(|(mine, more)| *mine += more);
    }
}

/// Accumulates errors over images. Errors of depth are means over images, as in benchmarks; errors of disparity are over
/// all pixels.
#[derive(Debug, Clone, Default)]
pub struct Depth {
    params: DepthParams,
    images: u64,
    /// Sums of the errors of each image, by key.
    depth: BTreeMap<&'static str, f64>,
    disparity: DisparityErrors,
}

impl Depth {
    fn add(&mut self, numbers: impl IntoIterator<Item = (&'static str, f64)>) {
        for (key, number) in numbers {
            *self.depth.entry(key).or_default() += number;
        }
    }
}

/// Predictions and ground truth are maps of scores `[height, width]`; ground truth of 0, NaN or infinity is ignored.
impl Metric for Depth {
    const NAME: &'static str = "depth";
    const ABOUT: &'static str = "errors and delta of depth (Eigen et al. 2014), also of aligned relative depth; end-point error, bad pixels and D1 of disparity";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("abs_rel", "Mean of |prediction - ground truth| / ground truth."),
        ("sq_rel", "Mean of (prediction - ground truth)^2 / ground truth, in metres."),
        ("rmse", "Root mean square error in metres, the mean over images."),
        ("rmse_log", "Root mean square error of logarithms."),
        (
            "silog",
            "Scale-invariant error: standard deviation of the error of logarithms (KITTI's, not times 100; Eigen et al. 2014).",
        ),
        ("delta<n>", "Fraction of pixels whose ratio to the ground truth is below 1.25^n."),
        ("end_point_error", "Mean absolute error of disparities, in pixels."),
        ("bad_<n>", "Fraction of pixels with an error of more than n pixels."),
        ("d1", "Fraction of pixels with an error of more than 3 pixels and 5 % (KITTI)."),
        ("images", "Number of images."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &[
        "abs_rel",
        "sq_rel",
        "rmse",
        "rmse_log",
        "silog",
        "end_point_error",
        "bad_1",
        "bad_2",
        "bad_3",
        "d1",
    ];
    type Params = DepthParams;
    type Prediction = Heatmap;
    type GroundTruth = Heatmap;

    fn new(params: &DepthParams) -> Result<Self> {
        let (min, max) = (params.min_depth, params.max_depth);
        if max.is_some_and(|max| max < min) {
            return Err(Error::invalid_param(format!("max_depth = {max:?} is below min_depth = {min}")));
        }
        if params.alignment == DepthAlignment::InverseScaleShift && max.is_none() {
            return Err(Error::invalid_param(
                "alignment inverse_scale_shift needs max_depth, to which inverse depths of 0 and less are set; papers use 10 m \
                 indoors (NYU) and 80 m on roads (KITTI)",
            ));
        }
        if params.alignment != DepthAlignment::None && params.quantity == DepthQuantity::Disparity {
            return Err(Error::invalid_param(
                "disparities are in pixels and are not aligned; leave alignment out",
            ));
        }
        Ok(Self { params: params.clone(), ..Self::default() })
    }

    fn update(&mut self, _at: usize, prediction: &Heatmap, ground_truth: &Heatmap) -> Result<f64> {
        let (HeatmapValues::Scores(given), HeatmapValues::Scores(expected)) =
            (prediction.values(), ground_truth.values())
        else {
            return Err(Error::invalid_input("depth must be a map of scores, not of labels"));
        };
        if prediction.shape() != ground_truth.shape() {
            let (given, expected) = (prediction.shape(), ground_truth.shape());
            return Err(Error::invalid_input(format!(
                "a map of shape {given:?} cannot be compared with one of {expected:?}; resize the prediction to the ground truth"
            )));
        }
        if self.params.quantity == DepthQuantity::Disparity {
            let errors = DisparityErrors::of(expected, given)?;
            self.disparity.add(&errors);
            self.images += u64::from(errors.pixels > 0);
            return Ok(1.0 - ratio(errors.outliers, errors.pixels).unwrap_or(0.0));
        }
        let range = [self.params.min_depth, self.params.max_depth.unwrap_or(f64::MAX)];
        let Some(errors) = DepthErrors::of(expected, given, range, self.params.alignment)? else {
            return Ok(1.0);
        };
        self.add(errors.numbers());
        self.images += 1;
        Ok(errors.within[0])
    }

    fn merge(&mut self, other: Self) {
        self.images += other.images;
        self.add(other.depth);
        self.disparity.add(&other.disparity);
    }

    fn finish(&self) -> Report {
        let disparity = self.params.quantity == DepthQuantity::Disparity;
        let mut report = Report::new(if disparity { "d1" } else { "abs_rel" });
        report.statistics.set("images", self.images as f64);
        if disparity {
            let DisparityErrors { pixels, distance, bad, outliers } = self.disparity;
            report.statistics.set("end_point_error", distance / pixels as f64);
            for (key, count) in
                ["bad_1", "bad_2", "bad_3", "d1"].into_iter().zip(bad.into_iter().chain([outliers]))
            {
                report.statistics.set(key, count as f64 / pixels as f64);
            }
        } else {
            for (key, sum) in &self.depth {
                report.statistics.set(*key, sum / self.images as f64);
            }
        }
        report
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [f64; 2] = [1e-3, f64::MAX];
    const NONE: DepthAlignment = DepthAlignment::None;

    fn map(depths: &[f32]) -> Heatmap {
        Heatmap::from_scores(depths.to_vec(), &[1, depths.len()]).unwrap()
    }

    #[test]
    fn depths_by_hand() {
        let ground_truth = [2.0, 4.0, 0.0, f32::NAN, f32::INFINITY];
        let errors =
            DepthErrors::of(&ground_truth, &[2.0, 5.0, 9.0, 9.0, f32::NAN], ALL, NONE).unwrap().unwrap();
        assert_eq!(errors.absolute_relative, 0.125);
        assert_eq!(errors.squared_relative, 0.125);
        assert_eq!(errors.rmse, 0.5_f64.sqrt());
        // 1.25 itself is not within 1.25.
        assert_eq!(errors.within, [0.5, 1.0, 1.0]);
        let log = 1.25_f64.ln();
        assert!((errors.rmse_log - (log * log / 2.0).sqrt()).abs() < 1e-12);
        assert!((errors.scale_invariant_log - log / 2.0).abs() < 1e-12);
    }

    #[test]
    fn predictions_are_clamped_to_the_range() {
        let errors = DepthErrors::of(&[10.0, 90.0], &[100.0, 1.0], [1.0, 80.0], NONE).unwrap().unwrap();
        assert_eq!(errors.absolute_relative, 7.0);
        assert_eq!(DepthErrors::of(&[90.0], &[1.0], [1.0, 80.0], NONE).unwrap(), None);
    }

    #[test]
    fn relative_depths_are_aligned_before_they_are_limited() {
        // 1 / depth = 0.25 d, and the last pixel's inverse depth is aligned to 0: as far as the limit.
        let (ground_truth, predicted) = ([4.0, 2.0, 1.0, 80.0], [1.0, 2.0, 4.0, 0.05]);
        let errors =
            DepthErrors::of(&ground_truth, &predicted, [1e-3, 80.0], DepthAlignment::InverseScaleShift);
        let errors = errors.unwrap().unwrap();
        assert!(errors.absolute_relative < 1e-6 && errors.within[0] == 1.0, "{errors:?}");
        let metres = DepthErrors::of(&ground_truth, &predicted, [1e-3, 80.0], NONE).unwrap().unwrap();
        assert!(metres.within[0] < 0.5);
    }

    #[test]
    fn outliers_exceed_pixels_and_fraction() {
        let ground_truth = [10.0, 10.0, 100.0, 100.0, 0.0];
        let errors = DisparityErrors::of(&ground_truth, &[13.0, 14.0, 104.0, 106.0, 50.0]).unwrap();
        assert_eq!((errors.pixels, errors.outliers, errors.bad), (4, 2, [4, 4, 3]));
        assert_eq!(errors.distance, 17.0);
    }

    #[test]
    fn images_have_equal_weight() {
        let mut depth = Depth::default();
        depth.update(0, &map(&[2.0]), &map(&[1.0])).unwrap();
        let mut other = Depth::default();
        assert_eq!(other.update(1, &map(&[2.0, 4.0, 1.0]), &map(&[2.0, 4.0, 0.0])).unwrap(), 1.0);
        other.update(2, &map(&[1.0]), &map(&[0.0])).unwrap();
        depth.merge(other);
        let report = depth.finish();
        assert_eq!(report.statistics.get("abs_rel"), Some(0.5));
        assert_eq!(report.statistics.get("images"), Some(2.0));
        assert_eq!(Depth::default().finish().statistics.get("rmse"), None);
    }

    #[test]
    fn invalid_maps_are_rejected() {
        let mut depth = Depth::default();
        assert!(depth.update(0, &map(&[1.0]), &map(&[1.0, 1.0])).is_err());
        assert!(depth.update(0, &map(&[f32::NAN]), &map(&[1.0])).is_err());
        assert!(depth.update(0, &Heatmap::from_labels(vec![1], &[1, 1]).unwrap(), &map(&[1.0])).is_err());
        assert!(DisparityErrors::of(&[1.0], &[f32::INFINITY]).is_err());
        let params = DepthParams { min_depth: 2.0, max_depth: Some(1.0), ..DepthParams::default() };
        assert!(Depth::new(&params).is_err());
        let relative = DepthAlignment::InverseScaleShift;
        let params = DepthParams { alignment: relative, ..DepthParams::default() };
        assert!(Depth::new(&params).unwrap_err().to_string().contains("needs max_depth"));
        let quantity = DepthQuantity::Disparity;
        let params = DepthParams { quantity, max_depth: Some(80.0), ..params };
        assert!(Depth::new(&params).unwrap_err().to_string().contains("leave alignment out"));
    }
}
