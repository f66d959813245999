//! Run lengths of a mask whose pixels are found column by column.

use opendr_engine::target::{Rle, Segment, Segmentation};
use opendr_engine::{Error, Result};

/// Run lengths of pixels that are set in ascending order.
#[derive(Debug, Default)]
pub struct MaskRuns {
    counts: Vec<u32>,
    end: usize,
    area: u64,
}

impl MaskRuns {
    /// Sets a pixel; pixels are numbered down the columns, from left to right, and each is above those before.
    pub fn set(&mut self, pixel: usize) {
        self.area += 1;
        match self.counts.last_mut() {
            // The last run is one of set pixels.
            Some(run) if self.end == pixel => *run += 1,
            _ => {
                self.counts.push((pixel - self.end) as u32);
                self.counts.push(1);
            }
        }
        self.end = pixel + 1;
    }

    /// Returns the mask, of an image of `[width, height]` pixels.
    ///
    /// # Errors
    /// `Format` when the image is too large for run lengths.
    pub fn finish(mut self, [width, height]: [usize; 2]) -> Result<Segment> {
        let pixels = width * height;
        if self.end < pixels {
            self.counts.push((pixels - self.end) as u32);
        }
        let side = |side: usize| {
            u32::try_from(side).map_err(|_| Error::format(format!("an image of {side} pixels has no masks")))
        };
        let rle = Rle::new(side(height)?, side(width)?, self.counts)?;
        Ok(Segment { segmentation: Segmentation::Rle(rle), area: self.area as f32, iscrowd: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_those_of_the_mask() {
        let mut runs = MaskRuns::default();
        [1, 2, 3, 5].into_iter().for_each(|pixel| runs.set(pixel));
        let segment = runs.finish([3, 3]).unwrap();
        let mask = [false, true, false, true, false, false, true, true, false];
        assert_eq!(segment.segmentation, Segmentation::Rle(Rle::from_mask(&mask, 3, 3).unwrap()));
        assert_eq!(segment.area, 4.0);
        let segment = MaskRuns::default().finish([2, 2]).unwrap();
        assert_eq!(segment.segmentation, Segmentation::Rle(Rle::new(2, 2, vec![4]).unwrap()));
        let mut full = MaskRuns::default();
        (0..4).for_each(|pixel| full.set(pixel));
        let Segmentation::Rle(rle) = full.finish([2, 2]).unwrap().segmentation else { panic!() };
        assert_eq!(rle.counts(), [0, 4]);
    }
}
