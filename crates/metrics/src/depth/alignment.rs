//! Alignment of depths that are known up to scale and shift with the ground truth of their image.

use opendr_engine::{Error, Result};

use super::pixels::pairs;

opendr_engine::choices! {
    /// How the predictions of an image are aligned with its ground truth before errors are computed.
    pub enum DepthAlignment {
        /// They are metres.
        None = "none",
        /// Depths, multiplied by the median of the ground truth divided by theirs (Zhou et al. 2017, Monodepth2).
        Median = "median",
        /// Depths, times a scale plus a shift, those of least squares with the ground truth.
        ScaleShift = "scale_shift",
        /// Inverse depths, times a scale plus a shift, those of least squares with the inverse of the ground truth (Ranftl et al.
        /// 2020, `MiDaS`); needs the largest depth.
        InverseScaleShift = "inverse_scale_shift",
    }
}

/// An alignment of the predictions of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlignedDepth {
    /// Factor of the predictions.
    pub scale: f64,
    /// What is added.
    pub shift: f64,
    /// Whether the sum is an inverse depth.
    pub is_inverse: bool,
}

impl AlignedDepth {
    /// Returns the depth of a prediction in metres; infinity where an inverse depth is not positive.
    pub fn depth(&self, prediction: f64) -> f64 {
        let aligned = self.scale * prediction + self.shift;
        match self.is_inverse {
            false => aligned,
            true if aligned > 0.0 => 1.0 / aligned,
            true => f64::INFINITY,
        }
    }
}

impl DepthAlignment {
    /// Aligns the predictions of an image over the pixels whose ground truth is finite and within `range` metres; `None` if there are
    /// none.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the maps differ in size, the prediction of such a pixel is NaN, or infinite where that prevents the
    /// alignment, or the median of the predictions is not positive.
    pub fn align(
        self,
        ground_truth: &[f32],
        predicted: &[f32],
        range: [f64; 2],
    ) -> Result<Option<AlignedDepth>> {
        let pairs = pairs(ground_truth, predicted, range)?;
        let is_inverse = self == Self::InverseScaleShift;
        Ok(match self {
            Self::None => {
                let mut pairs = pairs;
                pairs.next().map(|_| AlignedDepth { scale: 1.0, shift: 0.0, is_inverse })
            }
            Self::Median => {
                let (mut expected, mut given): (Vec<_>, Vec<_>) = pairs.unzip();
                let Some((expected, given)) = median(&mut expected).zip(median(&mut given)) else {
                    return Ok(None);
                };
                if !(given > 0.0 && given.is_finite()) {
                    return Err(Error::invalid_input(format!(
                        "the median of the predicted depths is {given}, which no scale makes a depth; choose another alignment"
                    )));
                }
                Some(AlignedDepth { scale: expected / given, shift: 0.0, is_inverse })
            }
            Self::ScaleShift => {
                least_squares(pairs)?.map(|[scale, shift]| AlignedDepth { scale, shift, is_inverse })
            }
            Self::InverseScaleShift => least_squares(pairs.map(|(expected, given)| (1.0 / expected, given)))?
                .map(|[scale, shift]| AlignedDepth { scale, shift, is_inverse }),
        })
    }
}

/// Returns the median, the mean of both middle numbers of an even count; `None` if there are no numbers.
fn median(numbers: &mut [f64]) -> Option<f64> {
    if numbers.is_empty() {
        return None;
    }
    let (middle, is_odd) = (numbers.len() / 2, !numbers.len().is_multiple_of(2));
    let (lower, upper, _) = numbers.select_nth_unstable_by(middle, f64::total_cmp);
    if is_odd {
        return Some(*upper);
    }
    lower.iter().copied().max_by(f64::total_cmp).map(|lower| f64::midpoint(lower, *upper))
}

/// Returns the scale and shift of the second numbers with the least squares to the first; `None` if there are no numbers. Where all of the
/// second are equal, the scale is 0.
fn least_squares(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> Result<Option<[f64; 2]>> {
    let (mut count, mut sums) = (0_u64, [0.0; 2]);
    for (expected, given) in pairs.clone() {
        count += 1;
        sums = [sums[0] + expected, sums[1] + given];
    }
    if count == 0 {
        return Ok(None);
    }
    // About the means, so that a large shift costs no precision.
    let [expected_mean, given_mean] = sums.map(|sum| sum / count as f64);
    if !given_mean.is_finite() {
        return Err(Error::invalid_input(
            "a predicted depth is infinite, which no scale aligns; give finite numbers",
        ));
    }
    let (mut covariance, mut variance) = (0.0, 0.0);
    for (expected, given) in pairs {
        let given = given - given_mean;
        covariance += given * (expected - expected_mean);
        variance += given * given;
    }
    let scale = if variance > 0.0 { covariance / variance } else { 0.0 };
    Ok(Some([scale, expected_mean - scale * given_mean]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [f64; 2] = [1e-3, f64::MAX];

    fn align(alignment: DepthAlignment, ground_truth: &[f32], predicted: &[f32]) -> AlignedDepth {
        alignment.align(ground_truth, predicted, ALL).unwrap().unwrap()
    }

    #[test]
    fn inverse_depths_are_aligned_in_inverse_depth() {
        // 1 / depth = 0.5 d - 0.25; what has no ground truth does not count.
        let (depths, predicted) = ([4.0, 0.8, 0.0, 4.0 / 3.0], [1.0, 3.0, 99.0, 2.0]);
        let found = align(DepthAlignment::InverseScaleShift, &depths, &predicted);
        assert!((found.scale - 0.5).abs() < 1e-6 && (found.shift + 0.25).abs() < 1e-6, "{found:?}");
        assert!((found.depth(2.5) - 1.0).abs() < 1e-6);
        assert_eq!(found.depth(0.1), f64::INFINITY);
    }

    #[test]
    fn depths_are_aligned_by_least_squares() {
        // numpy.linalg.lstsq([[1, 1], [2, 1], [4, 1]], [2, 3, 7]) of NumPy 2.5.
        let found = align(DepthAlignment::ScaleShift, &[2.0, 3.0, 7.0], &[1.0, 2.0, 4.0]);
        assert!((found.scale - 12.0 / 7.0).abs() < 1e-12 && found.shift.abs() < 1e-12, "{found:?}");
        let constant = align(DepthAlignment::ScaleShift, &[2.0, 3.0, 7.0], &[5.0; 3]);
        assert_eq!((constant.scale, constant.shift), (0.0, 4.0));
    }

    #[test]
    fn medians_of_even_counts_are_between_both() {
        let found = align(DepthAlignment::Median, &[1.0, 2.0, 4.0, 9.0], &[3.0, 1.0, 1.0, 1.0]);
        assert_eq!((found.scale, found.shift), (3.0, 0.0));
        assert_eq!(align(DepthAlignment::Median, &[2.0], &[4.0]).scale, 0.5);
        let zero = DepthAlignment::Median.align(&[2.0], &[0.0], ALL);
        assert!(zero.unwrap_err().to_string().contains("median"));
    }

    #[test]
    fn what_cannot_be_aligned_is_refused() {
        use DepthAlignment::{InverseScaleShift, Median, None, ScaleShift};
        for alignment in [None, Median, ScaleShift, InverseScaleShift] {
            assert_eq!(alignment.align(&[0.0, f32::NAN], &[1.0, 1.0], ALL).unwrap(), Option::None);
            assert!(alignment.align(&[1.0], &[f32::NAN], ALL).is_err());
        }
        for alignment in [ScaleShift, InverseScaleShift] {
            let error = alignment.align(&[1.0, 2.0], &[1.0, f32::INFINITY], ALL).unwrap_err();
            assert!(error.to_string().contains("infinite"), "{error}");
        }
    }
}
