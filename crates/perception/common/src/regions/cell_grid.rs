use super::Region;

/// A grid of cells over an image, marked by a first pass; its memory is reused.
#[derive(Debug, Clone, Default)]
pub struct CellGrid {
    columns: usize,
    rows: usize,
    marked: Vec<bool>,
    stack: Vec<usize>,
}

impl CellGrid {
    /// Resizes the grid and unmarks all cells.
    pub fn reset(&mut self, columns: usize, rows: usize) {
        (self.columns, self.rows) = (columns, rows);
        self.marked.clear();
        self.marked.resize(columns * rows, false);
    }

    /// Marks the cells for which `is_marked`, given column and row, is true.
    pub fn mark(&mut self, mut is_marked: impl FnMut(usize, usize) -> bool) {
        for (cell, marked) in self.marked.iter_mut().enumerate() {
            *marked |= is_marked(cell % self.columns, cell / self.columns);
        }
    }

    /// Unmarks the cells, of a grid over an image of `size`, that overlap a region.
    pub fn unmark(&mut self, region: &Region, size: [usize; 2]) {
        for cell in 0..self.marked.len() {
            self.marked[cell] &=
                !self.region([cell % self.columns, cell / self.columns], size).overlaps(region);
        }
    }

    /// Adds a region to `regions` for each 8-connected group of marked cells, of a grid over an image of `size`, up to
    /// `most` regions in all, in the order of their first cells. Unmarks the cells of these groups.
    pub fn take_regions(&mut self, size: [usize; 2], most: usize, regions: &mut Vec<Region>) {
        for first in 0..self.marked.len() {
            if regions.len() >= most || !std::mem::take(&mut self.marked[first]) {
                continue;
            }
            let mut region = self.region([first % self.columns, first / self.columns], size);
            self.stack.push(first);
            while let Some(cell) = self.stack.pop() {
                let (column, row) = (cell % self.columns, cell / self.columns);
                region = region.union(&self.region([column, row], size));
                for row in row.saturating_sub(1)..(row + 2).min(self.rows) {
                    for column in column.saturating_sub(1)..(column + 2).min(self.columns) {
                        let neighbour = row * self.columns + column;
                        if std::mem::take(&mut self.marked[neighbour]) {
                            self.stack.push(neighbour);
                        }
                    }
                }
            }
            if !region.is_empty() {
                regions.push(region);
            }
        }
    }

    fn region(&self, [column, row]: [usize; 2], [width, height]: [usize; 2]) -> Region {
        let edge = |at: usize, count: usize, length: usize| at * length / count;
        let (x, y) = (edge(column, self.columns, width), edge(row, self.rows, height));
        Region {
            x,
            y,
            width: edge(column + 1, self.columns, width) - x,
            height: edge(row + 1, self.rows, height) - y,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_touch_are_a_region() {
        let picture = [
            "##....", //
            "..#...", //
            ".....#", //
            "#....#",
        ];
        let mut grid = CellGrid::default();
        grid.reset(6, 4);
        let marked = |column: usize, row: usize| picture[row].as_bytes()[column] == b'#';
        let mut regions = Vec::new();
        grid.mark(marked);
        grid.take_regions([60, 40], 9, &mut regions);
        let region = |x, y, width, height| Region { x, y, width, height };
        assert_eq!(regions, [region(0, 0, 30, 20), region(50, 20, 10, 20), region(0, 30, 10, 10)]);
        regions.clear();
        grid.mark(marked);
        grid.unmark(&region(0, 0, 15, 15), [60, 40]);
        grid.take_regions([60, 40], 1, &mut regions);
        assert_eq!(regions, [region(20, 10, 10, 10)]);
    }
}
