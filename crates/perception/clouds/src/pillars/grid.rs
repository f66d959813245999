//! Grid on the ground.

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// A grid of square cells on the ground; each cell has a pillar from `z[0]` to `z[1]`. Metres, in the lidar's frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PillarGrid {
    /// Range ahead.
    pub x: [f32; 2],
    /// Range to the left.
    pub y: [f32; 2],
    /// Range upwards.
    pub z: [f32; 2],
    /// Side of a cell.
    pub side: f32,
}

/// Maximum number of cells.
const MOST_CELLS: f32 = (1 << 22) as f32;

impl PillarGrid {
    /// Returns the number of cells ahead.
    pub fn columns(&self) -> usize {
        ((self.x[1] - self.x[0]) / self.side).round() as usize
    }

    /// Returns the number of cells from right to left.
    pub fn rows(&self) -> usize {
        ((self.y[1] - self.y[0]) / self.side).round() as usize
    }

    /// Returns the number of cells.
    pub fn cells(&self) -> usize {
        self.columns() * self.rows()
    }

    /// Returns column and row of a point; `None` outside of the grid, and where a value is not finite.
    #[inline]
    pub fn cell(&self, [x, y, z]: [f32; 3]) -> Option<[u32; 2]> {
        // Comparisons with NaN are false.
        let inside = (x >= self.x[0]) & (x < self.x[1]) & (y >= self.y[0]) & (y < self.y[1]);
        if !(inside & (z >= self.z[0]) & (z < self.z[1])) {
            return None;
        }
        let last = |count: usize| count.saturating_sub(1) as u32;
        let at = |from: f32, place: f32, most: u32| (((place - from) / self.side) as u32).min(most);
        Some([at(self.x[0], x, last(self.columns())), at(self.y[0], y, last(self.rows()))])
    }

    /// Returns the centre of a cell, x and y.
    #[inline]
    pub fn middle(&self, [column, row]: [u32; 2]) -> [f32; 2] {
        [self.x[0] + (column as f32 + 0.5) * self.side, self.y[0] + (row as f32 + 0.5) * self.side]
    }

    /// Checks the grid of a container.
    ///
    /// # Errors
    /// `Format` for empty or infinite ranges, and for no cell or more than four million.
    pub fn check(&self) -> Result<()> {
        let ranges = [self.x, self.y, self.z];
        let sane = ranges.iter().all(|[from, to]| from.is_finite() && to.is_finite() && from < to);
        let [ahead, aside] = [self.x, self.y].map(|[from, to]| ((to - from) / self.side).round());
        if sane && self.side > 0.0 && ahead >= 1.0 && aside >= 1.0 && ahead * aside <= MOST_CELLS {
            return Ok(());
        }
        Err(Error::format(format!(
            "a grid of pillars needs increasing ranges and 1 to {MOST_CELLS} cells; this one is {self:?}"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: PillarGrid = PillarGrid { x: [0.0, 8.0], y: [-4.0, 4.0], z: [-3.0, 1.0], side: 0.5 };

    #[test]
    fn points_have_cells() {
        assert_eq!((GRID.columns(), GRID.rows(), GRID.cells()), (16, 16, 256));
        assert_eq!(GRID.cell([0.0, -4.0, -3.0]), Some([0, 0]));
        assert_eq!(GRID.cell([7.999_999_5, 0.2, 0.0]), Some([15, 8]));
        assert_eq!(GRID.middle([15, 8]), [7.75, 0.25]);
        for outside in
            [[8.0, 0.0, 0.0], [-0.01, 0.0, 0.0], [1.0, 4.0, 0.0], [1.0, 0.0, 1.0], [1.0, 0.0, -3.1]]
        {
            assert_eq!(GRID.cell(outside), None);
        }
        for strange in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38] {
            assert_eq!(GRID.cell([strange, 0.0, 0.0]), None);
            assert_eq!(GRID.cell([1.0, strange, 0.0]), None);
            assert_eq!(GRID.cell([1.0, 0.0, strange]), None);
        }
    }

    #[test]
    fn invalid_grids_are_refused() {
        GRID.check().unwrap();
        let wrong = [
            PillarGrid { side: 0.0, ..GRID },
            PillarGrid { side: f32::NAN, ..GRID },
            PillarGrid { side: 1e-6, ..GRID },
            PillarGrid { x: [1.0, 1.0], ..GRID },
            PillarGrid { y: [0.0, f32::INFINITY], ..GRID },
        ];
        assert!(wrong.iter().all(|grid| grid.check().is_err()));
    }
}
