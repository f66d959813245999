//! Union, intersection and extent of masks.

use crate::target::Rle;
use crate::{Error, Result};

impl Rle {
    /// Returns the box `[left, top, width, height]` around the object, in pixels; zeros if there is none.
    pub fn bounding_box(&self) -> [u32; 4] {
        let (height, mut at) = (u64::from(self.height), 0u64);
        let mut corners: Option<[u64; 4]> = None;
        for (index, run) in self.counts.iter().enumerate() {
            let (first, end) = (at, at + u64::from(*run));
            at = end;
            if index % 2 == 0 || first == end {
                continue;
            }
            let (x0, x1) = (first / height, (end - 1) / height);
            let (y0, y1) = if x0 < x1 { (0, height - 1) } else { (first % height, (end - 1) % height) };
            let [left, top, right, bottom] = corners.unwrap_or([x0, y0, x1, y1]);
            corners = Some([left.min(x0), top.min(y0), right.max(x1), bottom.max(y1)]);
        }
        let [left, top, right, bottom] = corners.map_or([0; 4], |[l, t, r, b]| [l, t, r + 1, b + 1]);
        [left, top, right - left, bottom - top].map(|pixels| pixels as u32)
    }

    /// Returns the number of pixels in both masks.
    ///
    /// # Errors
    /// Returns `InvalidInput` for masks of different sizes.
    pub fn intersection(&self, other: &Self) -> Result<u64> {
        let mut pixels = 0;
        self.walk(other, |run, [this, that]| pixels += if this && that { u64::from(run) } else { 0 })?;
        Ok(pixels)
    }

    /// Returns the mask of the pixels in either mask.
    ///
    /// # Errors
    /// Returns `InvalidInput` for masks of different sizes, or of 2^32 pixels or more.
    pub fn union(&self, other: &Self) -> Result<Self> {
        pixels(self.height, self.width)?;
        let (mut counts, mut inside) = (vec![0], false);
        self.walk(other, |run, [this, that]| {
            if (this || that) != inside {
                inside = !inside;
                counts.push(0);
            }
            if let Some(last) = counts.last_mut() {
                *last += run;
            }
        })?;
        Self::new(self.height, self.width, counts)
    }

    /// Visits the pixels of two masks together, in runs that are uniform in both.
    fn walk(&self, other: &Self, mut piece: impl FnMut(u32, [bool; 2])) -> Result<()> {
        if self.size() != other.size() {
            let ([height, width], [rows, columns]) = (self.size(), other.size());
            return Err(Error::invalid_input(format!(
                "masks of {height}x{width} and {rows}x{columns} pixels cannot be combined; \
                 both must have the size of the image"
            )));
        }
        let (mut these, mut those) = (self.counts.iter().copied(), other.counts.iter().copied());
        let (mut this, mut that) = (these.next(), those.next());
        let mut inside = [false; 2];
        while let (Some(left), Some(right)) = (this, that) {
            let run = left.min(right);
            piece(run, inside);
            this = Some(left - run);
            that = Some(right - run);
            if left == run {
                this = these.next();
                inside[0] = !inside[0];
            }
            if right == run {
                that = those.next();
                inside[1] = !inside[1];
            }
        }
        Ok(())
    }
}

/// Returns the number of pixels of an image.
///
/// # Errors
/// Returns `InvalidInput` if the number does not fit into 32 bits.
pub(super) fn pixels(height: u32, width: u32) -> Result<u32> {
    height.checked_mul(width).ok_or_else(|| {
        Error::invalid_input(format!("a mask of {height}x{width} pixels is too large; scale the image down"))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn masks() -> impl Strategy<Value = (Vec<bool>, Vec<bool>)> {
        let mask = || proptest::collection::vec(any::<bool>(), 5 * 7);
        (mask(), mask())
    }

    proptest! {
        #[test]
        fn equals_operations_on_pixels((this, that) in masks(), band in 0usize..35) {
            let this: Vec<bool> = this.iter().enumerate().map(|(at, inside)| *inside && at >= band).collect();
            let [left, right] = [&this, &that].map(|mask| Rle::from_mask(mask, 5, 7).unwrap());
            let pairs = || this.iter().zip(&that);
            prop_assert_eq!(
                left.intersection(&right).unwrap(),
                pairs().filter(|(a, b)| **a && **b).count() as u64
            );
            let either: Vec<bool> = pairs().map(|(a, b)| *a || *b).collect();
            prop_assert_eq!(left.union(&right).unwrap(), Rle::from_mask(&either, 5, 7).unwrap());
            let inside = || (0..35).filter(|at| this[*at]).map(|at| [at % 7, at / 7]);
            let extent = |axis: usize| {
                let (min, max) = (inside().map(|p| p[axis]).min(), inside().map(|p| p[axis]).max());
                min.zip(max).map_or([0, 0], |(min, max)| [min as u32, (max - min + 1) as u32])
            };
            let ([left_edge, width], [top, height]) = (extent(0), extent(1));
            prop_assert_eq!(left.bounding_box(), [left_edge, top, width, height]);
        }
    }

    #[test]
    fn masks_of_different_sizes_are_rejected() {
        let (wide, high) = (Rle::new(2, 3, vec![6]).unwrap(), Rle::new(3, 2, vec![0, 6]).unwrap());
        assert!(wide.union(&high).is_err() && wide.intersection(&high).is_err());
    }
}
