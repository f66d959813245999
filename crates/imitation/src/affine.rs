//! Scaling of observations and actions.

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// The scaling `(x - offset) / scale` of each number of a row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Affine {
    offset: Vec<f32>,
    scale: Vec<f32>,
}

/// Smallest scale: a number that never changes in the demonstrations is not blown up.
const SMALLEST: f32 = 1e-2;

impl Affine {
    /// Scales the rows to mean 0 and standard deviation 1, as ACT does.
    pub fn standard(rows: &[f32], width: usize) -> Self {
        let count = (rows.len() / width.max(1)).max(1) as f64;
        let column = |column: usize| rows.iter().skip(column).step_by(width).map(|&x| f64::from(x));
        let means = (0..width).map(|at| column(at).sum::<f64>() / count).collect::<Vec<_>>();
        let deviation = |at: usize| {
            (column(at).map(|x| (x - means[at]) * (x - means[at])).sum::<f64>() / count).sqrt() as f32
        };
        Self {
            scale: (0..width).map(|at| deviation(at).max(SMALLEST)).collect(),
            offset: means.iter().map(|&mean| mean as f32).collect(),
        }
    }

    /// Scales the smallest number of each column to -1 and the largest to 1, as diffusion policy does.
    pub fn unit_range(rows: &[f32], width: usize) -> Self {
        let bounds = |at: usize| {
            let column = rows.iter().skip(at).step_by(width);
            column.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], &x| [low.min(x), high.max(x)])
        };
        let bounds: Vec<_> = (0..width).map(bounds).collect();
        Self {
            offset: bounds.iter().map(|[low, high]| 0.5 * (low + high)).collect(),
            scale: bounds.iter().map(|[low, high]| (0.5 * (high - low)).max(SMALLEST)).collect(),
        }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> usize {
        self.offset.len()
    }

    /// Checks numbers that come from a file.
    ///
    /// # Errors
    /// `Format` for numbers that are not finite, or scales that are not positive.
    pub fn check(&self, width: usize) -> Result<()> {
        let finite = self.offset.iter().chain(&self.scale).all(|x| x.is_finite());
        if self.offset.len() != width
            || self.scale.len() != width
            || !finite
            || self.scale.iter().any(|&x| x <= 0.0)
        {
            return Err(Error::format(format!(
                "the scaling of {width} numbers is damaged; download or train the model again"
            )));
        }
        Ok(())
    }

    /// Writes the scaled rows.
    pub fn forward(&self, rows: &[f32], scaled: &mut [f32]) {
        let width = self.width();
        for (row, scaled) in rows.chunks_exact(width).zip(scaled.chunks_exact_mut(width)) {
            for (((scaled, x), offset), scale) in
                scaled.iter_mut().zip(row).zip(&self.offset).zip(&self.scale)
            {
                *scaled = (x - offset) / scale;
            }
        }
    }

    /// Reverses the scaling of one row in place.
    pub fn reverse(&self, row: &mut [f32]) {
        for ((x, offset), scale) in row.iter_mut().zip(&self.offset).zip(&self.scale) {
            *x = *x * scale + offset;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_scaled_and_back() {
        let rows = [1.0, 5.0, 3.0, 5.0, 5.0, 5.0];
        let mut scaled = [0.0; 6];
        let range = Affine::unit_range(&rows, 2);
        range.forward(&rows, &mut scaled);
        assert_eq!(scaled, [-1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let standard = Affine::standard(&rows, 2);
        standard.forward(&rows, &mut scaled);
        assert!((scaled[4] - 1.224_745).abs() < 1e-6 && scaled[5] == 0.0, "{scaled:?}");
        let mut row = [scaled[4], scaled[5]];
        standard.reverse(&mut row);
        assert!((row[0] - 5.0).abs() < 1e-6 && row[1] == 5.0);
        assert!(standard.check(2).is_ok() && standard.check(3).is_err());
    }
}
