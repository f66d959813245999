use opendr_engine::Result;
use opendr_engine::data::ImageView;
use opendr_vision::{ChannelOrder, Preprocess};

/// Mean and range of brightness of an image per cell; its memory is reused.
#[derive(Debug, Clone)]
pub struct CellBrightness {
    preprocess: Preprocess,
    columns: usize,
    rows: usize,
    grey: Vec<u8>,
    means: Vec<u8>,
    ranges: Vec<u8>,
}

impl Default for CellBrightness {
    fn default() -> Self {
        let preprocess = Preprocess::new(1, 1).order(ChannelOrder::Grey);
        Self { preprocess, columns: 0, rows: 0, grey: Vec::new(), means: Vec::new(), ranges: Vec::new() }
    }
}

impl CellBrightness {
    /// Computes mean and range over `columns` x `rows` cells (at least one each way) of `side` x `side` samples.
    ///
    /// # Errors
    /// As the pre-processing of images.
    pub fn compute(&mut self, view: ImageView<'_>, columns: usize, rows: usize, side: usize) -> Result<()> {
        let (columns, rows, side) = (columns.max(1), rows.max(1), side.max(1));
        (self.columns, self.rows) = (columns, rows);
        let width = columns * side;
        let coarse = self.preprocess.with_size(width, rows * side);
        self.grey.resize(coarse.len(), 0);
        coarse.run_into(view, &mut self.grey)?;
        self.means.clear();
        self.ranges.clear();
        for band in self.grey.chunks_exact(width * side) {
            for column in 0..columns {
                let (mut sum, mut low, mut high) = (0, u8::MAX, u8::MIN);
                for line in band.chunks_exact(width) {
                    for level in &line[column * side..(column + 1) * side] {
                        sum += u32::from(*level);
                        (low, high) = (low.min(*level), high.max(*level));
                    }
                }
                self.means.push((sum / (side * side) as u32) as u8);
                self.ranges.push(high.saturating_sub(low));
            }
        }
        Ok(())
    }

    /// Returns the number of columns and rows of cells.
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Returns the range of brightness in each cell, 0..=255, row by row.
    pub fn ranges(&self) -> &[u8] {
        &self.ranges
    }

    /// Returns the mean brightness of each cell, 0..=255, row by row.
    pub fn means(&self) -> &[u8] {
        &self.means
    }

    /// Returns the range of brightness in a cell; 0 outside the grid.
    pub fn range(&self, column: usize, row: usize) -> u8 {
        self.ranges.get(row * self.columns + column).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;

    use super::*;

    #[test]
    fn cells_have_mean_and_range_of_brightness() {
        // The left half is dark, the right half has alternating columns.
        let level = |at: usize| if at % 32 < 16 { 10 } else { [0, 200][at % 2] };
        let samples = (0..32 * 16).flat_map(|at| [level(at); 3]).collect();
        let image = Image::from_rgb8(samples, 32, 16).unwrap();
        let mut coarse = CellBrightness::default();
        coarse.compute(image.view(), 2, 1, 16).unwrap();
        assert_eq!(coarse.size(), [2, 1]);
        assert_eq!(coarse.means(), [10, 100]);
        assert_eq!((coarse.range(0, 0), coarse.range(1, 0), coarse.range(5, 5)), (0, 200, 0));
    }
}
